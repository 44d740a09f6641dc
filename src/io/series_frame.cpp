#include "series_frame.hpp"

#include "eigengrain/assembly/acting.hpp"
#include "eigengrain/base/assert.hpp"
#include "eigengrain/measures/measure.hpp"

#include "atomic_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <concepts>
#include <cstdint>
#include <functional>
#include <numeric>
#include <string>
#include <string_view>
#include <vector>

namespace eigengrain::io {
namespace {

static_assert(std::endian::native == std::endian::little, "numbers are written as they are in memory");
static_assert(sizeof(Vec3) == 3 * sizeof(double));

template <class T>
constexpr std::string_view type_name = "Float64";
template <>
constexpr std::string_view type_name<std::int64_t> = "Int64";
template <>
constexpr std::string_view type_name<std::int32_t> = "Int32";
template <>
constexpr std::string_view type_name<std::uint8_t> = "UInt8";

/// A tensor row by row, as VTK has it.
using Tensor = std::array<double, 9>;

template <class T>
constexpr std::string_view components = "";
template <>
constexpr std::string_view components<Vec3> = R"( NumberOfComponents="3")";
template <>
constexpr std::string_view components<Tensor> = R"( NumberOfComponents="9")";

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

/// Rows of the bodies in the order of identity.
std::vector<std::int32_t> rows_by_identity(const model::Bodies& bodies) {
  std::vector<std::int32_t> rows(bodies.identity.size());
  std::iota(rows.begin(), rows.end(), 0);
  std::sort(rows.begin(), rows.end(),
            [&](std::int32_t a, std::int32_t b) { return bodies.identity[a] < bodies.identity[b]; });
  return rows;
}

template <class T>
std::vector<T> gathered(const std::vector<T>& column, const std::vector<std::int32_t>& rows) {
  EIGENGRAIN_ASSERT(column.size() == rows.size(), column.size(), rows.size());
  std::vector<T> result;
  result.reserve(rows.size());
  for (const std::int32_t row : rows) result.push_back(column[static_cast<std::size_t>(row)]);
  return result;
}

/// How many contacts act on each body; one with the body's own image counts at both of its ends.
std::vector<std::int32_t> acting_contacts(const assembly::Model& model) {
  std::vector<std::int32_t> count(model.bodies.position.size());
  assembly::for_each_acting(model, [&](const auto& group, std::size_t c, const auto& /*geometry*/) {
    const contact::Pair& pair = group.pairs[c];
    ++count[static_cast<std::size_t>(pair.a)];
    if (std::decay_t<decltype(group)>::KinematicsType::second_is_body)
      ++count[static_cast<std::size_t>(pair.b)];
  });
  return count;
}

/// [rows] number of the clump of each ball, -1 for those of their own.
std::vector<std::int64_t> clumps_of(const model::Clumps& clumps, const std::vector<std::int32_t>& rows) {
  std::vector<std::int64_t> result;
  result.reserve(rows.size());
  for (const std::int32_t row : rows) {
    const std::int32_t clump = clumps.of(row);
    result.push_back(clump == model::Clumps::none ? -1 : clumps.identity[static_cast<std::size_t>(clump)]);
  }
  return result;
}

constexpr std::string_view frame_head =
    "<?xml version=\"1.0\"?>\n"
    "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n"
    "<UnstructuredGrid>\n";

/// xml: from frame_head to the last of the cells' arrays.
void write_frame(const std::filesystem::path& file, const std::string& xml, const AppendedArrays& arrays) {
  AtomicFile output(file);
  output.write(xml);
  output.write("</Cells>\n</Piece>\n</UnstructuredGrid>\n<AppendedData encoding=\"raw\">\n_");
  arrays.write(output);
  output.write("\n</AppendedData>\n</VTKFile>\n");
  output.commit();
}

Tensor rows_of(const Mat3& matrix) {
  Tensor rows;
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column)
      rows[static_cast<std::size_t>(3 * row + column)] = matrix(row, column);
  return rows;
}

std::vector<Tensor> stresses(const assembly::Model& model) {
  std::vector<Tensor> result;
  for (const Mat3& stress : measures::body_stresses(model)) result.push_back(rows_of(stress));
  return result;
}

template <class T>
std::vector<T> numbered_from(T first, std::size_t count) {
  std::vector<T> numbers(count);
  std::iota(numbers.begin(), numbers.end(), first);
  return numbers;
}

/// A cell for each of so many points: ParaView draws no points that belong to none.
std::string vertices(std::size_t count, AppendedArrays& arrays) {
  constexpr std::uint8_t vtk_vertex = 1;
  return arrays.add("connectivity", count, [=] { return numbered_from<std::int64_t>(0, count); }) +
         arrays.add("offsets", count, [=] { return numbered_from<std::int64_t>(1, count); }) +
         arrays.add("types", count, [=] { return std::vector<std::uint8_t>(count, vtk_vertex); });
}

}  // namespace

void write_frame(const std::filesystem::path& file, const assembly::State& state, bool stress) {
  const model::Bodies& bodies = state.model.bodies;
  const std::vector<std::int32_t> rows = rows_by_identity(bodies);
  const std::size_t count = rows.size();
  AppendedArrays arrays;
  const auto column = [&](std::string_view name, const auto& values) {
    return arrays.add(name, count, [&rows, from = &values] { return gathered(*from, rows); });
  };

  std::string xml = std::string(frame_head) + "<FieldData>\n";
  constexpr std::string_view one_tuple = R"( NumberOfTuples="1")";
  xml += arrays.add(
      "TimeValue", 1, [&] { return std::vector{state.time}; }, one_tuple);
  xml += arrays.add(
      "Step", 1, [&] { return std::vector{state.step}; }, one_tuple);
  const model::PeriodicCell& cell = state.model.cell;
  if (cell.any()) {
    xml += arrays.add(
        "CellOrigin", 1, [&] { return std::vector{cell.origin}; }, one_tuple);
    xml += arrays.add(
        "CellEdges", 1, [&] { return std::vector{rows_of(cell.edges)}; }, one_tuple);
  }
  xml += fmt::format("</FieldData>\n<Piece NumberOfPoints=\"{0}\" NumberOfCells=\"{0}\">\n", count);
  xml += "<PointData Scalars=\"radius\">\n";
  xml += column("radius", bodies.radius);
  xml += column("identity", bodies.identity);
  if (!bodies.clumps.empty())
    xml += arrays.add("clump", count, [&] { return clumps_of(bodies.clumps, rows); });
  if (!bodies.velocity.empty()) xml += column("velocity", bodies.velocity);
  if (!bodies.spin.empty()) xml += column("spin", bodies.spin);
  xml += column("force", state.force);
  xml += arrays.add("contacts", count, [&] { return gathered(acting_contacts(state.model), rows); });
  if (stress) xml += arrays.add("stress", count, [&] { return gathered(stresses(state.model), rows); });
  xml += "</PointData>\n<Points>\n";
  xml += column("Points", bodies.position);
  xml += "</Points>\n<Cells>\n" + vertices(count, arrays);
  write_frame(file, xml, arrays);
}

void write_surface_frame(const std::filesystem::path& file, const assembly::Model& model) {
  std::vector<Vec3> points;
  std::vector<std::int64_t> corners;
  std::vector<std::int32_t> walls;
  for (std::size_t s = 0; s < model.surfaces.size(); ++s) {
    const contact::SurfacePlace& place = model.surface_places[s];
    const auto first = static_cast<std::int64_t>(points.size());
    for (const Vec3& x : model.surfaces[s].vertices)
      points.push_back(place.moved ? place.pose.point(x, place.start) : x);
    for (const model::Triangle& triangle : model.surfaces[s].triangles) {
      for (const std::int32_t vertex : triangle) corners.push_back(first + vertex);
      walls.push_back(static_cast<std::int32_t>(model.walls.size() + s));
    }
  }
  const std::size_t cells = walls.size();
  constexpr std::uint8_t vtk_triangle = 5;
  AppendedArrays arrays;
  const auto given = [&](std::string_view name, const auto& values) {
    return arrays.add(name, values.size(), [from = &values] { return *from; });
  };
  std::string xml =
      fmt::format("{}<Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">\n", frame_head, points.size(), cells);
  xml += "<CellData Scalars=\"wall\">\n" + given("wall", walls) + "</CellData>\n";
  xml += "<Points>\n" + given("Points", points) + "</Points>\n<Cells>\n" + given("connectivity", corners);
  xml += arrays.add("offsets", cells, [=] {
    std::vector<std::int64_t> ends(cells);
    for (std::size_t k = 0; k < cells; ++k) ends[k] = static_cast<std::int64_t>(3 * k + 3);
    return ends;
  });
  xml += arrays.add("types", cells, [=] { return std::vector<std::uint8_t>(cells, vtk_triangle); });
  write_frame(file, xml, arrays);
}

void write_break_frame(const std::filesystem::path& file, std::span<const assembly::BondBreak> breaks) {
  const std::size_t count = breaks.size();
  AppendedArrays arrays;
  const auto column = [&](std::string_view name, auto of) {
    return arrays.add(name, count, [breaks, of] {
      std::vector<std::invoke_result_t<decltype(of), const assembly::BondBreak&>> values;
      for (const assembly::BondBreak& found : breaks) values.push_back(of(found));
      return values;
    });
  };
  std::string xml =
      fmt::format("{0}<Piece NumberOfPoints=\"{1}\" NumberOfCells=\"{1}\">\n<PointData Scalars=\"time\">\n",
                  frame_head, count);
  xml += column("time", [](const auto& found) { return found.time; });
  xml += column("step", [](const auto& found) { return found.step; });
  xml += column("mode", [](const auto& found) { return static_cast<std::int32_t>(found.mode); });
  xml += column("ball_a", [](const auto& found) { return found.first; });
  xml += column("ball_b", [](const auto& found) { return found.second; });
  xml += column("normal", [](const auto& found) { return found.normal; });
  xml += "</PointData>\n<Points>\n" + column("Points", [](const auto& found) { return found.place; });
  xml += "</Points>\n<Cells>\n" + vertices(count, arrays);
  write_frame(file, xml, arrays);
}

}  // namespace eigengrain::io
