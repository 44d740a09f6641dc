#include "eigengrain/assembly/contact_list.hpp"
#include "eigengrain/assembly/moving_walls.hpp"
#include "eigengrain/assembly/surroundings.hpp"
#include "eigengrain/base/error.hpp"
#include "eigengrain/io/state_file.hpp"

#include "fingerprint.hpp"
#include "hdf5.hpp"
#include "restore_contacts.hpp"
#include "seal.hpp"
#include "settings_reader.hpp"
#include "state_layout.hpp"
#include "text_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <system_error>
#include <utility>

namespace eigengrain::io {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view what_to_use = "use an earlier state, or start from the scene";

[[noreturn]] void refuse(const fs::path& file, std::string message) {
  throw InputError({{file.string(), 0, std::move(message)}});
}

/// Whatever says that it is a state, of a schema that this program knows.
void check_format(const h5::File& hdf5, const fs::path& file) {
  const bool ours = hdf5.has_attribute(layout::root, "format") &&
                    hdf5.text(layout::root, "format") == layout::format &&
                    hdf5.has_attribute(layout::root, "schema");
  if (!ours) refuse(file, "an HDF5 file, but no state of Eigengrain; states are what a run writes");
  const std::int64_t schema = hdf5.integer(layout::root, "schema");
  if (schema >= layout::oldest_schema && schema <= layout::schema) return;
  refuse(file, fmt::format("{}: its schema is {}, and this program reads {} to {}; read it with the program "
                           "that wrote it",
                           schema > layout::schema ? "written by a newer version" : "no schema that exists",
                           schema, layout::oldest_schema, layout::schema));
}

void check_is_file(const fs::path& file) {
  std::error_code error;
  if (!fs::exists(file, error)) throw InputError(missing_file(file));
  if (fs::is_directory(file, error)) refuse(file, "a folder, not a state file");
}

/// Opens the file only if every byte is as it was written, since HDF5 does not withstand all damage.
h5::File open_whole(const fs::path& file) {
  check_is_file(file);
  const Seal seal = check_seal(file);
  if (seal == Seal::broken)
    refuse(file, fmt::format("damaged: its checksum is not that of its contents; {}", what_to_use));
  if (!is_state_file(file))
    refuse(file, "no state file: it does not begin as HDF5 does; states are what a run writes");
  h5::File hdf5 = h5::File::open(file);
  check_format(hdf5, file);
  if (seal == Seal::missing)
    refuse(file, fmt::format("cut short or damaged: the checksum at its end is missing; {}", what_to_use));
  return hdf5;
}

bool finite(const Vec3& x) {
  return std::isfinite(x[0]) && std::isfinite(x[1]) && std::isfinite(x[2]);
}

void read_bodies(const h5::File& hdf5, assembly::State& state) {
  const std::size_t count = hdf5.rows(layout::position);
  layout::for_each_column(state, [&](const std::string& path, auto& column) {
    column = hdf5.read<typename std::decay_t<decltype(column)>::value_type>(path, count);
  });
  model::Bodies& bodies = state.model.bodies;
  if (hdf5.has(layout::spin)) bodies.spin = hdf5.read<Vec3>(layout::spin, count);
  if (hdf5.has(layout::orientation)) bodies.orientation = hdf5.read<Quat>(layout::orientation, count);
  if (hdf5.has(layout::moment)) state.moment = hdf5.read<Vec3>(layout::moment, count);
  for (std::size_t i = 0; i < count; ++i) {
    if (!finite(bodies.position[i]))
      throw h5::Error(fmt::format("the position of ball {} is not finite", bodies.identity[i]));
    // Written so that not-a-number fails too. Rounding leaves some ulps.
    if (!bodies.orientation.empty() && !(std::abs(bodies.orientation[i].squaredNorm() - 1) < 1e-12))
      throw h5::Error(fmt::format("the orientation of ball {} is no unit quaternion", bodies.identity[i]));
    if (!(bodies.radius[i] > 0) || !std::isfinite(bodies.radius[i]))
      throw h5::Error(
          fmt::format("the radius of ball {} is {} m, not positive", bodies.identity[i], bodies.radius[i]));
  }
}

/// Whether every ball is a piece of one clump at most, and every clump has balls.
bool members_are_sound(const model::Clumps& clumps, std::int32_t balls) {
  if (clumps.starts.front() != 0 || clumps.starts.back() != static_cast<std::int32_t>(clumps.member.size()) ||
      std::adjacent_find(clumps.starts.begin(), clumps.starts.end(), std::greater_equal<>()) !=
          clumps.starts.end())
    return false;
  std::vector<char> seen(static_cast<std::size_t>(balls), 0);
  return std::all_of(clumps.member.begin(), clumps.member.end(), [&](std::int32_t row) {
    return row >= 0 && row < balls && std::exchange(seen[static_cast<std::size_t>(row)], 1) == 0;
  });
}

void read_clumps(const h5::File& hdf5, assembly::State& state) {
  if (!hdf5.has(layout::clumps)) return;
  model::Bodies& bodies = state.model.bodies;
  model::Clumps& clumps = bodies.clumps;
  const std::size_t count = hdf5.rows("/clumps/identity");
  layout::for_each_clump_column(clumps, [&](const std::string& path, auto& column) {
    const bool of_balls = path == "/clumps/member" || path == "/clumps/place";
    const std::size_t rows = of_balls                   ? hdf5.rows("/clumps/member")
                             : path == "/clumps/starts" ? count + 1
                                                        : count;
    column = hdf5.read<typename std::decay_t<decltype(column)>::value_type>(path, rows);
  });
  if (!members_are_sound(clumps, bodies.size())) throw h5::Error("the balls of the clumps make no sense");
  if (bodies.spin.empty() || state.moment.empty())
    throw h5::Error("clumps, but balls without spin or moment");
  for (std::size_t c = 0; c < count; ++c) {
    if (!finite(clumps.position[c]) || !(std::abs(clumps.orientation[c].squaredNorm() - 1) < 1e-12))
      throw h5::Error(fmt::format("clump {} has no place or no unit quaternion", c));
    if (!(clumps.mass[c] > 0) || !(clumps.inertia[c].minCoeff() > 0))
      throw h5::Error(fmt::format("mass or inertia of clump {} is not positive", c));
  }
  clumps.of_row.assign(bodies.position.size(), model::Clumps::none);
  for (std::int32_t c = 0; c < clumps.size(); ++c)
    for (const std::int32_t row : clumps.members(c)) clumps.of_row[static_cast<std::size_t>(row)] = c;
}

void read_list(const h5::File& hdf5, assembly::State& state) {
  state.list.skin = hdf5.number(layout::list, "skin");
  state.list.rebuilds = hdf5.integer(layout::list, "rebuilds");
  const std::size_t rows = hdf5.rows(layout::list_position);
  state.list.position =
      hdf5.read<Vec3>(layout::list_position, rows == 0 ? 0 : state.model.bodies.position.size());
}

Mat3 read_matrix(const h5::File& hdf5, const std::string& path) {
  const std::vector<double> rows = hdf5.read_doubles(path, 3, 3);
  const Mat3 matrix = Mat3(rows.data()).transpose();
  if (!matrix.allFinite()) throw h5::Error(fmt::format("{} is not finite", path));
  return matrix;
}

/// Puts the periodic cell where it was, if it has moved; its velocity gradient may be a new one.
void read_cell(const h5::File& hdf5, const model::Scene& stored, const fs::path& file,
               assembly::State& state) {
  model::PeriodicCell& cell = state.model.cell;
  state.list.edges = cell.edges;
  if (!hdf5.has(layout::cell)) return;
  if (state.settings.cell.origin != stored.cell.origin || state.settings.cell.edges != stored.cell.edges)
    refuse(file,
           "periodic: another box or origin than that of the state, whose cell has moved since; leave "
           "them out (a velocity_gradient may change), or start from the scene");
  cell.edges = read_matrix(hdf5, layout::cell_edges);
  cell.rate = read_matrix(hdf5, layout::cell_rate);
  state.list.edges = read_matrix(hdf5, layout::list_cell_edges);
  for (int k = 0; k < 3; ++k)
    if (cell.periodic[static_cast<std::size_t>(k)] && !(cell.edges.col(k).norm() > 0))
      throw h5::Error("an edge of the periodic cell is zero");
}

/// The settings name files of meshes, which may have changed since.
void refuse_changed_meshes(const h5::File& hdf5, const model::Scene& stored, const fs::path& file) {
  if (!hdf5.has(layout::surfaces)) return;
  const std::vector<std::int64_t> now = fingerprints(stored.surfaces);
  const auto then = hdf5.read<std::int64_t>(layout::surface_fingerprint, now.size());
  for (std::size_t s = 0; s < now.size(); ++s)
    if (now[s] != then[s])
      refuse(file,
             fmt::format("{}: its file has other triangles than when the state was written, and contacts "
                         "name them by number; put the file back, or start from the scene",
                         stored.surfaces[s].name));
}

/// Puts the walls that had moved where they were. Others that move now begin where the settings say.
void read_walls(const h5::File& hdf5, const fs::path& file, assembly::State& state) {
  assembly::Model& model = state.model;
  if (!hdf5.has(layout::walls)) return;
  const std::size_t count = hdf5.rows(layout::wall_index);
  const auto index = hdf5.read<std::int32_t>(layout::wall_index, count);
  const auto centre = hdf5.read<Vec3>(layout::wall_centre, count);
  const auto orientation = hdf5.read_doubles(layout::wall_orientation, count, 4);
  for (std::size_t k = 0; k < count; ++k) {
    const auto found = std::find_if(model.wall_motions.begin(), model.wall_motions.end(),
                                    [&](const auto& motion) { return motion.wall == index[k]; });
    if (found == model.wall_motions.end())
      refuse(file, fmt::format("walls: wall number {} has moved since the start, and stands still now; keep "
                               "its motion, or stop it with a velocity of [0, 0, 0]",
                               index[k] + 1));
    const double* q = &orientation[4 * k];
    model.wall_poses[static_cast<std::size_t>(found - model.wall_motions.begin())] = {
        centre[k], Eigen::Quaterniond(q[3], q[0], q[1], q[2])};
  }
  state.list.wall_way = hdf5.number(layout::list, "wall_way");
  state.list.wall_lever = hdf5.read<double>(layout::list_wall_lever, hdf5.rows(layout::list_wall_lever));
  assembly::place_walls(state);
}

/// An integral that the file does not know yet began at zero when its program did.
void read_ledger(const h5::File& hdf5, assembly::State& state) {
  if (!hdf5.has(layout::ledger)) return;
  layout::for_each_energy(state.ledger.emplace(), [&](const std::string& name, double& energy) {
    if (hdf5.has_attribute(layout::ledger, name.c_str())) energy = hdf5.number(layout::ledger, name.c_str());
  });
}

/// Overrides may not pull away what the stored numbers rest upon.
void refuse_changes(const model::Scene& stored, const model::Scene& now, const fs::path& file) {
  if (now.materials.size() != stored.materials.size())
    refuse(file, fmt::format("materials: {} entries; the state has {}, and its balls name them by number; "
                             "keep their number and their order",
                             now.materials.size(), stored.materials.size()));
  for (std::size_t k = 0; k < now.materials.size(); ++k)
    if (now.materials[k].density != stored.materials[k].density)
      refuse(file, fmt::format("materials[{}].density: {} kg/m3; the balls of a state have their masses from "
                               "{} kg/m3 and keep them; leave it out, or start from the scene",
                               k, now.materials[k].density, stored.materials[k].density));
  for (std::size_t r = 0; r < std::min(now.contacts.size(), stored.contacts.size()); ++r) {
    const auto kind = [&](const model::Scene& scene) {
      const auto& bond = scene.contacts[r].bond;
      return bond ? bond->kind : std::string("none");
    };
    if (kind(now) != kind(stored))
      refuse(file,
             fmt::format("contacts[{}].bond: {}; the bonds of a state are those it was started with ({}); "
                         "keep the kind, or start from the scene",
                         now.contacts[r].entry, kind(now), kind(stored)));
  }
  if (now.walls.size() != stored.walls.size())
    refuse(file, fmt::format("walls: {} planes; the state has {}, and its contacts name them by number; keep "
                             "their number and their order",
                             now.walls.size(), stored.walls.size()));
  const auto triangles = [](const model::Scene& scene) {
    std::vector<std::size_t> counts;
    for (const model::Surface& surface : scene.surfaces) counts.push_back(surface.triangles.size());
    return counts;
  };
  if (triangles(now) != triangles(stored))
    refuse(file,
           "walls: other polygons or meshes than those of the state, whose contacts name their "
           "triangles by number; keep them");
  if (now.cell.periodic != stored.cell.periodic)
    refuse(file, "periodic: other axes than those of the state, whose contacts reach through them");
}

bool same_place(const model::Plane& first, const model::Plane& second) {
  return first.point == second.point && first.normal == second.normal && first.centre == second.centre;
}

/// Whether contacts may be elsewhere than where the neighbour list looked for them.
bool surroundings_moved(const model::Scene& stored, const model::Scene& now) {
  return now.cell.origin != stored.cell.origin || now.cell.edges != stored.cell.edges ||
         !std::equal(now.walls.begin(), now.walls.end(), stored.walls.begin(), stored.walls.end(),
                     same_place) ||
         !std::equal(now.surfaces.begin(), now.surfaces.end(), stored.surfaces.begin(), stored.surfaces.end(),
                     [](const model::Surface& l, const model::Surface& r) {
                       return l.vertices == r.vertices && l.two_sided == r.two_sided && l.centre == r.centre;
                     });
}

/// Whether pairs may have a law that had none: those are not in the list.
bool pairs_may_be_new(const model::Scene& stored, const model::Scene& now) {
  const auto same_rule = [](const model::ContactRule& l, const model::ContactRule& r) {
    return l.first == r.first && l.second == r.second && l.law == r.law;
  };
  const auto same_material = [](const model::Plane& l, const model::Plane& r) {
    return l.material == r.material;
  };
  return !std::equal(now.contacts.begin(), now.contacts.end(), stored.contacts.begin(), stored.contacts.end(),
                     same_rule) ||
         !std::equal(now.walls.begin(), now.walls.end(), stored.walls.begin(), stored.walls.end(),
                     same_material) ||
         !std::equal(
             now.surfaces.begin(), now.surfaces.end(), stored.surfaces.begin(), stored.surfaces.end(),
             [](const model::Surface& l, const model::Surface& r) { return l.material == r.material; });
}

model::Scene read_settings(const std::string& document, const fs::path& file,
                           std::span<const std::string> overrides, const model::Bodies& bodies) {
  return read_settings_text(document, file.parent_path(), file.string() + ", settings", overrides,
                            bodies.material);
}

assembly::State read_contents(const h5::File& hdf5, const fs::path& file,
                              std::span<const std::string> overrides) {
  assembly::State state;
  layout::for_each_number(state, [&](const char* name, auto& value) {
    if constexpr (std::is_integral_v<std::decay_t<decltype(value)>>)
      value = hdf5.integer(layout::root, name);
    else
      value = hdf5.number(layout::root, name);
  });
  read_bodies(hdf5, state);
  read_clumps(hdf5, state);
  read_list(hdf5, state);
  read_ledger(hdf5, state);
  const std::string document = hdf5.read_text(layout::settings);
  const model::Scene stored = read_settings(document, file, {}, state.model.bodies);
  state.settings = read_settings(document, file, overrides, state.model.bodies);
  state.settings.name = hdf5.text(layout::root, "scene");
  refuse_changed_meshes(hdf5, stored, file);
  refuse_changes(stored, state.settings, file);
  assembly::set_surroundings(state.model, state.settings);
  read_cell(hdf5, stored, file, state);
  read_walls(hdf5, file, state);
  state.model.contacts = restore_contacts(hdf5, state.settings, state.model, file.string());
  if (surroundings_moved(stored, state.settings) || pairs_may_be_new(stored, state.settings))
    assembly::renew_list(state, state.list.skin);
  // Friction that comes on lets balls turn that could not before.
  if (state.model.bodies.spin.empty() && !assembly::needs_rotation(stored) &&
      assembly::needs_rotation(state.settings)) {
    state.model.bodies.spin.assign(state.model.bodies.position.size(), Vec3::Zero());
    state.moment = state.model.bodies.spin;
  }
  return state;
}

}  // namespace

assembly::State read_state(const fs::path& file, std::span<const std::string> overrides) {
  const h5::Silence silence;
  try {
    return read_contents(open_whole(file), file, overrides);
  } catch (const h5::Error& error) {
    refuse(file,
           fmt::format("damaged, cut short or made by something else: {}; {}", error.what(), what_to_use));
  } catch (const std::system_error& error) {
    refuse(file, fmt::format("cannot be read: {}", error.code().message()));
  }
}

}  // namespace eigengrain::io
