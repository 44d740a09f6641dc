#include "eigengrain/base/text.hpp"

namespace eigengrain {

std::string grouped(std::int64_t number) {
  std::string digits = std::to_string(number);
  const std::size_t first = number < 0 ? 1 : 0;
  for (std::size_t left = digits.size(); left > first + 3; left -= 3) digits.insert(left - 3, 1, ',');
  return digits;
}

}  // namespace eigengrain
