#pragma once

#include "eigengrain/base/assert.hpp"
#include "eigengrain/model/bodies.hpp"

#include "atomic_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <concepts>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <numeric>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

/// Files of VTK with the numbers as they are in memory behind the XML.
namespace eigengrain::io::vtk {

static_assert(std::endian::native == std::endian::little, "numbers are written as they are in memory");
static_assert(sizeof(Vec3) == 3 * sizeof(double));

template <class T>
inline constexpr std::string_view type_name = "Float64";
template <>
inline constexpr std::string_view type_name<std::int64_t> = "Int64";
template <>
inline constexpr std::string_view type_name<std::int32_t> = "Int32";
template <>
inline constexpr std::string_view type_name<std::uint8_t> = "UInt8";

/// A tensor row by row, as VTK has it.
using Tensor = std::array<double, 9>;

template <class T>
inline constexpr std::string_view components = "";
template <>
inline constexpr std::string_view components<Vec3> = R"( NumberOfComponents="3")";
template <>
inline constexpr std::string_view components<Tensor> = R"( NumberOfComponents="9")";

template <class T>
std::string_view bytes_of(const std::vector<T>& values) {
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)};
}

/// The arrays that are appended to the XML. What each holds is computed only when it is written, so that no
/// two of them are in memory at once.
class AppendedArrays {
 public:
  /// Takes note of an array of `count` rows and returns its element.
  template <std::invocable Make>
  std::string add(std::string_view name, std::size_t count, Make make, std::string_view more = {}) {
    using Value = typename std::invoke_result_t<Make>::value_type;
    const std::uint64_t size = count * sizeof(Value);
    std::string element =
        fmt::format("<DataArray type=\"{}\" Name=\"{}\"{}{} format=\"appended\" offset=\"{}\"/>\n",
                    type_name<Value>, name, components<Value>, more, offset_);
    offset_ += sizeof(size) + size;
    writers_.emplace_back([size, make](AtomicFile& file) {
      file.write({reinterpret_cast<const char*>(&size), sizeof(size)});
      const std::vector<Value> values = make();
      EIGENGRAIN_ASSERT(values.size() * sizeof(Value) == size, values.size(), size);
      file.write(bytes_of(values));
    });
    return element;
  }

  void write(AtomicFile& file) const {
    for (const auto& writer : writers_) writer(file);
  }

 private:
  std::vector<std::function<void(AtomicFile&)>> writers_;
  std::uint64_t offset_ = 0;
};

enum class Rows { balls, balls_and_nodes };

/// Rows of the bodies in the order of identity.
inline std::vector<std::int32_t> rows_by_identity(const model::Bodies& bodies, Rows which) {
  std::vector<std::int32_t> rows;
  rows.reserve(bodies.identity.size());
  for (std::int32_t row = 0; row < bodies.size(); ++row)
    if (which == Rows::balls_and_nodes || bodies.radius[static_cast<std::size_t>(row)] > 0)
      rows.push_back(row);
  std::sort(rows.begin(), rows.end(),
            [&](std::int32_t a, std::int32_t b) { return bodies.identity[a] < bodies.identity[b]; });
  return rows;
}

template <class T>
std::vector<T> gathered(const std::vector<T>& column, const std::vector<std::int32_t>& rows) {
  EIGENGRAIN_ASSERT(column.size() >= rows.size(), column.size(), rows.size());
  std::vector<T> result;
  result.reserve(rows.size());
  for (const std::int32_t row : rows) result.push_back(column[static_cast<std::size_t>(row)]);
  return result;
}

inline constexpr std::string_view frame_head =
    "<?xml version=\"1.0\"?>\n"
    "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n"
    "<UnstructuredGrid>\n";

/// xml: from frame_head to the last of the cells' arrays.
inline void write_frame(const std::filesystem::path& file, const std::string& xml,
                        const AppendedArrays& arrays) {
  AtomicFile output(file);
  output.write(xml);
  output.write("</Cells>\n</Piece>\n</UnstructuredGrid>\n<AppendedData encoding=\"raw\">\n_");
  arrays.write(output);
  output.write("\n</AppendedData>\n</VTKFile>\n");
  output.commit();
}

template <class T>
std::vector<T> numbered_from(T first, std::size_t count) {
  std::vector<T> numbers(count);
  std::iota(numbers.begin(), numbers.end(), first);
  return numbers;
}

/// A cell for each of so many points: ParaView draws no points that belong to none.
inline std::string vertices(std::size_t count, AppendedArrays& arrays) {
  constexpr std::uint8_t vtk_vertex = 1;
  return arrays.add("connectivity", count, [=] { return numbered_from<std::int64_t>(0, count); }) +
         arrays.add("offsets", count, [=] { return numbered_from<std::int64_t>(1, count); }) +
         arrays.add("types", count, [=] { return std::vector<std::uint8_t>(count, vtk_vertex); });
}

}  // namespace eigengrain::io::vtk
