#include "text.hpp"

#include "eigengrain/base/error.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cstring>
#include <fstream>

namespace eigengrain::app {

std::string counted(std::int64_t number, const std::string& one, const std::string& many) {
  return fmt::format("{} {}", grouped(number), number == 1 ? one : many);
}

void print_notes(const model::Scene& scene) {
  for (const std::string& note : scene.notes) fmt::print("note: {}\n", note);
}

void write_json(const std::string& file, const nlohmann::ordered_json& document) {
  if (file.empty()) return;
  std::ofstream out(file);
  out << document.dump(2) << '\n';
  out.flush();
  if (!out)
    throw InputError(fmt::format("--json {}: cannot write there ({}); name a file in a folder that exists",
                                 file, std::strerror(errno)));
}

}  // namespace eigengrain::app
