#include "eigengrain/io/mode_file.hpp"

#include "eigengrain/assembly/clump_members.hpp"

#include "vtk_file.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace eigengrain::io {
namespace {

/// What each ball does, from what its body does.
struct BallMotion {
  std::vector<Vec3> displacement;
  std::vector<Vec3> rotation;
  std::vector<double> energy;
};

BallMotion motion_of_balls(const model::Bodies& bodies, const ModeShape& mode) {
  BallMotion result;
  double largest = 0;  // of the radius
  for (std::int32_t row = 0; row < bodies.size(); ++row) {
    const auto owner = static_cast<std::size_t>(bodies.clumps.owner(row));
    const Vec3& turn = mode.rotation[owner];
    const Vec3 moved = mode.displacement[owner] + turn.cross(assembly::lever_of(bodies, row));
    result.displacement.push_back(moved);
    result.rotation.push_back(turn);
    result.energy.push_back(mode.energy[owner]);
    largest = std::max({largest, moved.norm() / bodies.radius[static_cast<std::size_t>(row)], turn.norm()});
  }
  const double scale = largest > 0 ? 1 / largest : 1.0;
  for (Vec3& moved : result.displacement) moved *= scale;
  for (Vec3& turn : result.rotation) turn *= scale;
  return result;
}

}  // namespace

void write_modes(const std::filesystem::path& file, const model::Bodies& bodies,
                 std::span<const ModeShape> modes) {
  const std::vector<std::int32_t> rows = vtk::rows_by_identity(bodies, vtk::Rows::balls_and_nodes);
  const std::size_t count = rows.size();
  std::vector<BallMotion> motions;
  for (const ModeShape& mode : modes) motions.push_back(motion_of_balls(bodies, mode));
  vtk::AppendedArrays arrays;
  const auto column = [&](const std::string& name, const auto& values) {
    return arrays.add(name, count, [&rows, from = &values] { return vtk::gathered(*from, rows); });
  };
  std::string xml =
      fmt::format("{0}<Piece NumberOfPoints=\"{1}\" NumberOfCells=\"{1}\">\n", vtk::frame_head, count);
  xml += "<PointData Scalars=\"radius\">\n" + column("radius", bodies.radius);
  xml += column("identity", bodies.identity);
  for (std::size_t k = 0; k < motions.size(); ++k) {
    const std::string name = fmt::format("mode_{}", k + 1);
    xml += column(name + "_displacement", motions[k].displacement);
    xml += column(name + "_rotation", motions[k].rotation);
    xml += column(name + "_energy", motions[k].energy);
  }
  xml += "</PointData>\n<Points>\n" + column("Points", bodies.position);
  xml += "</Points>\n<Cells>\n" + vtk::vertices(count, arrays);
  vtk::write_frame(file, xml, arrays);
}

}  // namespace eigengrain::io
