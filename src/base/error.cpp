#include "eigengrain/base/error.hpp"

#include <fmt/format.h>

#include <utility>

namespace eigengrain {
namespace {

std::string all_texts(const std::vector<Mistake>& mistakes) {
  std::string text;
  for (const Mistake& m : mistakes) {
    if (!text.empty()) text += '\n';
    text += m.text();
  }
  return text;
}

}  // namespace

std::string Mistake::text() const {
  if (file.empty()) return message;
  if (line <= 0) return fmt::format("{}: {}", file, message);
  return fmt::format("{}:{}: {}", file, line, message);
}

InputError::InputError(std::vector<Mistake> mistakes)
    : std::runtime_error(all_texts(mistakes)), mistakes_(std::move(mistakes)) {}

InputError::InputError(std::string message) : InputError(std::vector<Mistake>{{"", 0, std::move(message)}}) {}

}  // namespace eigengrain
