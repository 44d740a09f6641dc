#include "seal.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <span>
#include <string_view>
#include <system_error>
#include <vector>

namespace eigengrain::io {
namespace {

static_assert(std::endian::native == std::endian::little, "the seal is written as it stands in memory");

constexpr std::string_view mark = "EGR-SEAL";
constexpr std::size_t checksum_at = mark.size() + sizeof(std::uint64_t);
constexpr std::size_t seal_size = checksum_at + sizeof(std::uint32_t);

/// tables[k][b]: what byte b does to the CRC when k more bytes follow it.
constexpr auto tables = [] {
  constexpr std::uint32_t polynomial = 0xEDB88320U;  // of zlib, PNG and Ethernet, bits reflected
  std::array<std::array<std::uint32_t, 256>, 8> t{};
  for (std::uint32_t b = 0; b < 256; ++b) {
    t[0][b] = b;
    for (int k = 0; k < 8; ++k) t[0][b] = (t[0][b] >> 1U) ^ ((t[0][b] & 1U) != 0 ? polynomial : 0U);
  }
  for (std::size_t k = 1; k < 8; ++k)
    for (std::uint32_t b = 0; b < 256; ++b) t[k][b] = (t[k - 1][b] >> 8U) ^ t[0][t[k - 1][b] & 0xFFU];
  return t;
}();

/// CRC-32, eight bytes at a time.
class Checksum {
 public:
  void add(std::span<const char> bytes) {
    while (bytes.size() >= 8) {
      std::uint64_t word = 0;
      std::memcpy(&word, bytes.data(), sizeof word);
      word ^= crc_;
      crc_ = 0;
      for (std::size_t k = 0; k < 8; ++k) crc_ ^= tables[7 - k][(word >> (8 * k)) & 0xFFU];
      bytes = bytes.subspan(8);
    }
    for (const char byte : bytes)
      crc_ = (crc_ >> 8U) ^ tables[0][(crc_ ^ static_cast<unsigned char>(byte)) & 0xFFU];
  }
  std::uint32_t value() const { return ~crc_; }

 private:
  std::uint32_t crc_ = 0xFFFFFFFFU;
};

[[noreturn]] void fail(const char* what) {
  throw std::system_error(errno != 0 ? errno : EIO, std::generic_category(), what);
}

Checksum checksum_of(std::ifstream& input, std::uint64_t length) {
  Checksum sum;
  std::vector<char> buffer(1U << 20U);
  input.seekg(0);
  while (length > 0) {
    const std::uint64_t piece = std::min<std::uint64_t>(length, buffer.size());
    if (!input.read(buffer.data(), static_cast<std::streamsize>(piece))) fail("read");
    sum.add(std::span(buffer).first(piece));
    length -= piece;
  }
  return sum;
}

std::ifstream open_to_read(const std::filesystem::path& file) {
  errno = 0;
  std::ifstream input(file, std::ios::binary);
  if (!input) fail("open");
  return input;
}

}  // namespace

std::string seal_of(std::span<const char> bytes) {
  const std::uint64_t length = bytes.size();
  std::string seal(mark);
  seal.append(reinterpret_cast<const char*>(&length), sizeof length);
  Checksum sum;
  sum.add(bytes);
  sum.add(seal);
  const std::uint32_t value = sum.value();
  return seal.append(reinterpret_cast<const char*>(&value), sizeof value);
}

Seal check_seal(const std::filesystem::path& file) {
  const std::uint64_t size = std::filesystem::file_size(file);
  if (size < seal_size) return Seal::missing;
  const std::uint64_t length = size - seal_size;
  std::ifstream input = open_to_read(file);
  std::array<char, seal_size> seal{};
  input.seekg(static_cast<std::streamoff>(length));
  if (!input.read(seal.data(), seal.size())) fail("read");
  if (std::string_view(seal.data(), mark.size()) != mark) return Seal::missing;
  std::uint64_t sealed_length = 0;
  std::uint32_t sealed_value = 0;
  std::memcpy(&sealed_length, seal.data() + mark.size(), sizeof sealed_length);
  std::memcpy(&sealed_value, seal.data() + checksum_at, sizeof sealed_value);
  if (sealed_length != length) return Seal::broken;
  Checksum sum = checksum_of(input, length);
  sum.add(std::span(seal).first(checksum_at));
  return sum.value() == sealed_value ? Seal::intact : Seal::broken;
}

}  // namespace eigengrain::io
