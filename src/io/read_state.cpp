#include "eigengrain/assembly/cell_motion.hpp"
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
#include "state_changes.hpp"
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

/// Numbers that the cycle would divide by, or that would let it run away.
void check_own_columns(const model::Bodies& bodies) {
  const auto require = [&](bool sound, std::size_t i, const char* what) {
    if (!sound) throw h5::Error(fmt::format("the {} of ball {} makes no sense", what, bodies.identity[i]));
  };
  for (std::size_t i = 0; i < bodies.applied_force.size(); ++i)
    require(finite(bodies.applied_force[i]), i, "force");
  for (std::size_t i = 0; i < bodies.applied_moment.size(); ++i)
    require(finite(bodies.applied_moment[i]), i, "moment");
  for (std::size_t i = 0; i < bodies.damping.size(); ++i) {
    const double alpha = bodies.damping[i];
    require(alpha == model::Bodies::scene_damping || (alpha >= 0 && alpha < 1), i, "damping");
  }
  for (std::size_t i = 0; i < bodies.mass_factor.size(); ++i)
    require(bodies.mass_factor[i] > 0 && std::isfinite(bodies.mass_factor[i]), i, "mass factor");
  for (std::size_t i = 0; i < bodies.ramp.size(); ++i) {
    const model::RadiusRamp& ramp = bodies.ramp[i];
    require(ramp.factor > 0 && ramp.over > 0 && std::isfinite(ramp.factor) && std::isfinite(ramp.from) &&
                (ramp.factor == 1 || (ramp.radius > 0 && ramp.mass > 0 && ramp.inertia > 0)),
            i, "growth");
  }
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
  layout::for_each_own_column(bodies, [&](const std::string& path, auto& column) {
    if (hdf5.has(path)) column = hdf5.read<typename std::decay_t<decltype(column)>::value_type>(path, count);
  });
  check_own_columns(bodies);
  for (std::size_t i = 0; i < count; ++i) {
    if (!finite(bodies.position[i]))
      throw h5::Error(fmt::format("the position of ball {} is not finite", bodies.identity[i]));
    // Written so that not-a-number fails too. Rounding leaves some ulps.
    if (!bodies.orientation.empty() && !(std::abs(bodies.orientation[i].squaredNorm() - 1) < 1e-12))
      throw h5::Error(fmt::format("the orientation of ball {} is no unit quaternion", bodies.identity[i]));
    const bool may_be_node = bodies.radius[i] == 0 && hdf5.has(layout::deformables);
    if ((!(bodies.radius[i] > 0) && !may_be_node) || !std::isfinite(bodies.radius[i]))
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
  if (hdf5.has_attribute(layout::list, "growth")) state.list.growth = hdf5.number(layout::list, "growth");
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

/// Which bodies are the nodes of deformable ones.
void find_nodes(const h5::File& hdf5, const fs::path& file, std::vector<model::Deformable>& deformables) {
  const std::size_t there = hdf5.has(layout::deformables) ? hdf5.rows(layout::deformable_first_node) : 0;
  if (there != deformables.size())
    refuse(file,
           fmt::format("deformables: {} where the state has {}; keep their number, or start from the scene",
                       deformables.size(), there));
  if (there == 0) return;
  const auto first_node = hdf5.read<std::int64_t>(layout::deformable_first_node, there);
  const auto then = hdf5.read<std::int64_t>(layout::deformable_fingerprint, there);
  for (std::size_t d = 0; d < there; ++d) {
    deformables[d].first_node = first_node[d];
    if (fingerprint(deformables[d].mesh) != then[d])
      refuse(file,
             fmt::format("{}: its mesh is another one than when the state was written; put the file back, or "
                         "start from the scene",
                         deformables[d].name));
  }
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

/// A proof of the step goes on only where it is asked for as before.
void read_guard(const h5::File& hdf5, const model::Scene& stored, assembly::State& state) {
  const model::TimestepChoice& then = stored.timestep;
  const model::TimestepChoice& now = state.settings.timestep;
  if (!hdf5.has(layout::guard) || now.policy != then.policy || now.safety != then.safety) return;
  assembly::StepGuard& guard = state.guard.emplace();
  layout::for_each_guard_number(guard, [&](const char* name, auto& value) {
    if constexpr (std::is_integral_v<std::decay_t<decltype(value)>>)
      value = hdf5.integer(layout::guard, name);
    else
      value = hdf5.number(layout::guard, name);
  });
  const std::size_t count = state.model.bodies.position.size();
  layout::for_each_guard_column(guard, [&](const std::string& path, auto& column) {
    column = hdf5.read<typename std::decay_t<decltype(column)>::value_type>(path, count);
  });
  if (!std::all_of(guard.weight.begin(), guard.weight.end(), [](double d) { return d > 0; }))
    throw h5::Error("a weight of the proof of the step is not positive");
}

void read_groups(const h5::File& hdf5, assembly::State& state) {
  for (std::size_t k = 0;; ++k) {
    const std::string path = fmt::format("{}/{}", layout::groups, k);
    if (!hdf5.has(path)) return;
    const std::string balls = path + "/balls";
    state.groups.push_back({hdf5.text(path, "name"), hdf5.read<std::int64_t>(balls, hdf5.rows(balls))});
  }
}

void read_progress(const h5::File& hdf5, assembly::State& state) {
  if (!hdf5.has(layout::progress)) return;
  layout::for_each_progress(state.progress, [&](const char* name, auto& value) {
    using Value = std::decay_t<decltype(value)>;
    if constexpr (std::is_same_v<Value, double>)
      value = hdf5.number(layout::progress, name);
    else
      value = static_cast<Value>(hdf5.integer(layout::progress, name));
  });
  if (state.progress.stage < 0 || state.progress.repetition < 0)
    throw h5::Error("a stage of a negative number");
}

bool scaling_changed(const model::Scene& stored, const model::Scene& now) {
  const auto& then = stored.mass_scaling;
  if (then.has_value() != now.mass_scaling.has_value()) return true;
  return then && (then->form != now.mass_scaling->form || then->dt != now.mass_scaling->dt);
}

/// The true masses until the cycle chooses. Where time runs otherwise with other inertial masses, what moves
/// freely has velocities that mean nothing: it starts from rest. What is prescribed goes on.
void begin_other_masses(const model::Scene& stored, assembly::State& state) {
  model::Bodies& bodies = state.model.bodies;
  bodies.mass_factor.clear();
  assembly::forget_step(state);
  if (model::keeps_time(stored.mass_scaling) && model::keeps_time(state.settings.mass_scaling)) return;
  state.dt = 0;
  const auto stop = [](Vec3& v, std::uint8_t fixed) { v -= model::free_part(v, fixed); };
  const assembly::Fluctuation fluctuation(state.model.cell);  // the flow of a cell goes on
  const auto stop_at = [&](Vec3& v, const Vec3& x, std::uint8_t fixed) {
    v -= model::free_part(fluctuation.of(v, x), fixed);
  };
  for (std::size_t i = 0; i < bodies.velocity.size(); ++i)
    stop_at(bodies.velocity[i], bodies.position[i], bodies.fixed[i].translation());
  for (std::size_t i = 0; i < bodies.spin.size(); ++i) stop(bodies.spin[i], bodies.fixed[i].rotation());
  model::Clumps& clumps = bodies.clumps;
  for (std::int32_t c = 0; c < clumps.size(); ++c) {
    const auto k = static_cast<std::size_t>(c);
    const model::FixedComponents fixed = bodies.fixed[static_cast<std::size_t>(clumps.holder(c))];
    stop_at(clumps.velocity[k], clumps.position[k], fixed.translation());
    stop(clumps.spin[k], fixed.rotation());
    clumps.angular_momentum[k] = model::angular_momentum(clumps, c, clumps.spin[k]);
  }
}

model::Scene read_settings(const std::string& document, const fs::path& file,
                           std::span<const std::string> overrides, const model::Bodies& bodies) {
  std::vector<std::int32_t> of_balls;  // nodes of deformable bodies are none
  for (std::size_t i = 0; i < bodies.material.size(); ++i)
    if (!assembly::is_node(bodies, i)) of_balls.push_back(bodies.material[i]);
  return read_settings_text(document, file.parent_path(), file.string() + ", settings", overrides, of_balls);
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
  read_groups(hdf5, state);
  read_progress(hdf5, state);
  const std::string document = hdf5.read_text(layout::settings);
  const model::Scene stored = read_settings(document, file, {}, state.model.bodies);
  state.settings = read_settings(document, file, overrides, state.model.bodies);
  state.settings.name = hdf5.text(layout::root, "scene");
  refuse_changed_meshes(hdf5, stored, file);
  find_nodes(hdf5, file, state.settings.deformables);
  if (const auto problem = forbidden_change(stored, state.settings)) refuse(file, *problem);
  assembly::set_surroundings(state.model, state.settings);
  assembly::set_solids(state.model, state.settings.deformables);
  read_cell(hdf5, stored, file, state);
  read_walls(hdf5, file, state);
  state.model.contacts = restore_contacts(hdf5, state.settings, state.model, file.string());
  const bool list_is_old =
      surroundings_moved(stored, state.settings) || pairs_may_be_new(stored, state.settings);
  if (list_is_old) assembly::renew_list(state, state.list.skin);
  if (!list_is_old) read_guard(hdf5, stored, state);
  if (scaling_changed(stored, state.settings)) begin_other_masses(stored, state);
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
