#include "read_surfaces.hpp"
#include "scene_draft.hpp"
#include "wall_motion_keys.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace eigengrain::io {
namespace {

constexpr std::array<char, 3> axis_names{'x', 'y', 'z'};

/// An entry of `walls`, whose planes it adds to the draft.
struct WallEntry {
  const Section& section;
  std::size_t number;  ///< from 1
  std::int32_t material;
  SceneDraft& draft;
  WallMotionKeys motion;

  /// centre: where the entry says none; area: 0 without an own
  void add(const Vec3& point, const Vec3& normal, std::string_view what, const Vec3& centre,
           double area) const {
    const auto index = static_cast<std::int32_t>(draft.scene.walls.size());
    draft.scene.walls.push_back(
        {point, normal, material, fmt::format("wall {} ({})", number, what), motion.centre.value_or(centre)});
    draft.wall_places.push_back(section.place());
    add_motion(index, draft.scene.walls.back().centre, normal, area);
    check_turn_against_cell(normal);
  }

  /// normal, area: zero without an own
  void add(model::Surface surface, std::string_view what, const Vec3& normal, double area) const {
    surface.material = material;
    surface.name = fmt::format("wall {} ({})", number, what);
    surface.centre = motion.centre.value_or(middle_of(surface));
    // Until the planes have been counted: -1, -2, ...
    const auto index = -1 - static_cast<std::int32_t>(draft.scene.surfaces.size());
    add_motion(index, surface.centre, normal, area);
    draft.scene.surfaces.push_back(std::move(surface));
  }

 private:
  void add_motion(std::int32_t index, const Vec3& centre, const Vec3& normal, double area) const {
    if (auto given = wall_motion(section, motion, index, centre, normal, area))
      draft.scene.wall_motions.push_back(std::move(*given));
  }

  /// A plane that turns out of a periodic axis would not repeat any more.
  void check_turn_against_cell(const Vec3& normal) const {
    const model::PeriodicCell& cell = draft.scene.cell;
    for (const model::WallVelocity& row : motion.velocity)
      for (int k = 0; k < 3; ++k) {
        const bool stays = row.spin.cross(normal)[k] == 0 && row.spin.dot(normal) * row.spin[k] == 0;
        if (!cell.periodic[static_cast<std::size_t>(k)] || stays) continue;
        return section.report(
            fmt::format("the spin ({:g}, {:g}, {:g}) rad/s turns the wall out of {}, which "
                        "is periodic, so it would not repeat; turn it about that axis, or "
                        "leave {} out of periodic.axes",
                        row.spin[0], row.spin[1], row.spin[2], axis_names[k], axis_names[k]));
      }
  }
};

/// Components of a unit normal below this come from rounding: a repeated plane is then off by less than any
/// position is.
constexpr double negligible_component = 1e-12;

void check_against_cell(const Section& plane, const Vec3& normal, const model::PeriodicCell& cell) {
  for (int k = 0; k < 3; ++k) {
    const auto axis = static_cast<std::size_t>(k);
    if (cell.periodic[axis] && std::abs(normal[k]) > negligible_component)
      plane.report("normal",
                   fmt::format("has a component along {0}, which is periodic, so the plane would not "
                               "repeat; give it none, or leave {0} out of periodic.axes",
                               axis_names[axis]));
  }
}

void read_plane(const WallEntry& wall, const Section& plane) {
  plane.check_keys();
  const auto point = plane.vector("point");
  const auto normal = plane.vector("normal");
  if (!normal) return;
  const double length = normal->stableNorm();
  if (length == 0)
    return plane.report("normal", "zero, which has no direction; write e.g. \"normal: [0, 0, 1]\"");
  // Scaling by the largest component first keeps very long and very short vectors from over- or underflowing.
  const Vec3 unit = (*normal / normal->cwiseAbs().maxCoeff()).normalized();
  check_against_cell(plane, unit, wall.draft.scene.cell);
  if (point) wall.add(*point, unit, "plane", *point, 0);
}

/// The six sides of a box, as scene files name them.
struct Side {
  int axis = 0;
  bool upper = false;

  std::string name() const { return fmt::format("{}{}", upper ? '+' : '-', axis_names[axis]); }
};
constexpr std::array<Side, 6> sides{{{0, false}, {0, true}, {1, false}, {1, true}, {2, false}, {2, true}}};

double area_of(const Side& side, const Vec3& edges) {
  return edges[(side.axis + 1) % 3] * edges[(side.axis + 2) % 3];
}

bool check_corners(const Section& box, const Vec3& lower, const Vec3& upper) {
  for (int k = 0; k < 3; ++k) {
    if (lower[k] < upper[k]) continue;
    box.report("max", fmt::format("{0} = {1} m is not above the {0} = {2} m of min", axis_names[k], upper[k],
                                  lower[k]));
    return false;
  }
  return true;
}

/// A wall across a periodic axis would cut the cell.
void check_open_along_cell(const Section& box, const std::vector<Side>& closed,
                           const model::PeriodicCell& cell) {
  std::string missing;
  for (const Side& side : closed)
    if (cell.periodic[side.axis]) missing += fmt::format("{}{}", missing.empty() ? "" : ", ", side.name());
  if (!missing.empty())
    box.report("open",
               fmt::format("the sides {} stand across axes that are periodic; add them to open", missing));
}

void read_box(const WallEntry& wall, const Section& box) {
  box.check_keys();
  const auto lower = box.vector("min");
  const auto upper = box.vector("max");
  const auto open = box.texts("open");
  if (!lower || !upper || !open || !check_corners(box, *lower, *upper)) return;
  std::vector<Side> closed;
  for (const Side& side : sides)
    if (std::find(open->begin(), open->end(), side.name()) == open->end()) closed.push_back(side);
  if (closed.empty()) return box.report("open", "all six sides, which leaves no wall; remove the box");
  check_open_along_cell(box, closed, wall.draft.scene.cell);
  for (const Side& side : closed)
    wall.add(side.upper ? *upper : *lower, (side.upper ? -1.0 : 1.0) * Vec3::Unit(side.axis),
             "box " + side.name(), 0.5 * (*lower + *upper), area_of(side, *upper - *lower));
}

/// Surfaces are numbered behind the planes, all of which are known only in the end.
void number_surface_motions(model::Scene& scene) {
  const auto planes = static_cast<std::int32_t>(scene.walls.size());
  for (model::WallMotion& motion : scene.wall_motions)
    if (motion.wall < 0) motion.wall = planes - 1 - motion.wall;
}

}  // namespace

void read_walls(const Section& root, SceneDraft& draft) {
  const std::int64_t mistakes_before = root.diagnostics().count();
  std::size_t number = 0;
  for (const Section& section : root.sections("walls")) {
    section.check_keys();
    const std::int32_t material = read_material(section, "material", draft.scene);
    const WallEntry wall{section, ++number, material, draft, read_wall_motion(section, draft.folder)};
    const int shapes =
        section.has("plane") + section.has("box") + section.has("polygon") + section.has("mesh");
    if (shapes != 1) {
      section.report(
          "either a plane or a box is wanted, e.g. \"plane: {point: [0, 0, 0], normal: [0, 0, 1]}\", or a "
          "polygon or a mesh");
      continue;
    }
    if (const auto plane = section.section("plane")) read_plane(wall, *plane);
    if (const auto box = section.section("box")) read_box(wall, *box);
    if (const auto polygon = section.section("polygon"))
      if (auto surface = read_polygon(*polygon)) {
        const Vec3 area = area_vector(*surface);
        wall.add(std::move(*surface), "polygon", area.normalized(), area.norm());
      }
    if (const auto mesh = section.section("mesh"))
      if (auto surface = read_mesh_section(*mesh, draft.folder))
        wall.add(std::move(*surface),
                 fmt::format("mesh {}",
                             std::filesystem::path(mesh->text("file").value_or("")).filename().string()),
                 Vec3::Zero(), 0);
  }
  number_surface_motions(draft.scene);
  draft.walls_complete = root.diagnostics().count() == mistakes_before;
}

}  // namespace eigengrain::io
