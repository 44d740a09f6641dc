#include "eigengrain/io/state_file.hpp"

#include <array>
#include <fstream>
#include <string_view>

namespace eigengrain::io {

bool is_state_file(const std::filesystem::path& file) {
  constexpr std::string_view signature = "\x89HDF\r\n\x1a\n";
  std::array<char, signature.size()> begin{};
  std::ifstream input(file, std::ios::binary);
  return input.read(begin.data(), begin.size()) && std::string_view(begin.data(), begin.size()) == signature;
}

}  // namespace eigengrain::io
