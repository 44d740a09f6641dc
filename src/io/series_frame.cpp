#include "series_frame.hpp"

#include "eigengrain/assembly/acting.hpp"
#include "eigengrain/measures/measure.hpp"

#include "vtk_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <string>
#include <string_view>
#include <vector>

namespace eigengrain::io {
namespace {

using namespace vtk;

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

Tensor rows_of(const Mat3& matrix) {
  Tensor rows;
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column)
      rows[static_cast<std::size_t>(3 * row + column)] = matrix(row, column);
  return rows;
}

std::uint8_t vtk_type(model::ElementKind kind) {
  switch (kind) {
    case model::ElementKind::hex8:
      return 12;
    case model::ElementKind::tet10:
      return 24;
    case model::ElementKind::tet4:
      break;
  }
  return 10;
}

std::vector<Tensor> stresses(const assembly::Model& model) {
  std::vector<Tensor> result;
  for (const Mat3& stress : measures::body_stresses(model)) result.push_back(rows_of(stress));
  return result;
}

}  // namespace

void write_frame(const std::filesystem::path& file, const assembly::State& state, bool stress) {
  const model::Bodies& bodies = state.model.bodies;
  const std::vector<std::int32_t> rows =
      rows_by_identity(bodies, Rows::balls);  // nodes are in frames of their own
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
  vtk::write_frame(file, xml, arrays);
}

void write_solid_frame(const std::filesystem::path& file, const assembly::State& state) {
  const model::Bodies& bodies = state.model.bodies;
  std::vector<Vec3> points;
  std::vector<Vec3> displacement;
  std::vector<Vec3> velocity;
  std::vector<std::int64_t> identity;
  std::vector<std::int64_t> corners;
  std::vector<std::int64_t> ends;
  std::vector<std::uint8_t> types;
  std::vector<std::int32_t> body;
  std::vector<Tensor> stress;
  std::vector<double> mises;
  std::array<Vec3, fem::most_nodes> x;
  for (std::size_t s = 0; s < state.model.solids.size(); ++s) {
    const assembly::Solid& solid = *state.model.solids[s];
    const auto first = static_cast<std::int64_t>(points.size());
    for (std::size_t node = 0; node < solid.row.size(); ++node) {
      const auto row = static_cast<std::size_t>(solid.row[node]);
      points.push_back(bodies.position[row]);
      displacement.emplace_back(bodies.position[row] - solid.deformable.mesh.nodes[node]);
      velocity.push_back(bodies.velocity.empty() ? Vec3(Vec3::Zero()) : bodies.velocity[row]);
      identity.push_back(bodies.identity[row]);
    }
    const auto nodes = static_cast<std::size_t>(solid.elements.nodes());
    for (std::int32_t e = 0; e < solid.elements.size(); ++e) {
      for (const std::int32_t node : solid.deformable.mesh.element(e)) corners.push_back(first + node);
      ends.push_back(static_cast<std::int64_t>(corners.size()));
      types.push_back(vtk_type(solid.deformable.mesh.kind));
      body.push_back(static_cast<std::int32_t>(s));
      solid.gather(e, bodies.position, x);
      const Mat3 sigma = solid.elements.mean_stress(solid.deformable.solid, e, std::span(x).first(nodes));
      stress.push_back(rows_of(sigma));
      const Mat3 deviator = sigma - sigma.trace() / 3 * Mat3::Identity();
      mises.push_back(std::sqrt(1.5) * deviator.norm());
    }
  }
  AppendedArrays arrays;
  const auto given = [&](std::string_view name, const auto& values) {
    return arrays.add(name, values.size(), [from = &values] { return *from; });
  };
  std::string xml = fmt::format("{}<Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">\n", frame_head,
                                points.size(), types.size());
  xml += "<PointData Vectors=\"displacement\">\n" + given("displacement", displacement) +
         given("velocity", velocity) + given("identity", identity) + "</PointData>\n";
  xml += "<CellData Scalars=\"von_mises\">\n" + given("von_mises", mises) + given("stress", stress) +
         given("body", body) + "</CellData>\n";
  xml += "<Points>\n" + given("Points", points) + "</Points>\n<Cells>\n" + given("connectivity", corners) +
         given("offsets", ends) + given("types", types);
  vtk::write_frame(file, xml, arrays);
}

void write_surface_frame(const std::filesystem::path& file, const assembly::Model& model) {
  std::vector<Vec3> points;
  std::vector<std::int64_t> corners;
  std::vector<std::int32_t> walls;
  for (std::size_t s = 0; s + model.solids.size() < model.surfaces.size(); ++s) {  // without skins
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
  vtk::write_frame(file, xml, arrays);
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
  vtk::write_frame(file, xml, arrays);
}

}  // namespace eigengrain::io
