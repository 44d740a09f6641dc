#include "eigengrain/base/assert.hpp"
#include "eigengrain/base/error.hpp"
#include "eigengrain/base/parallel.hpp"
#include "eigengrain/contact/state_numbers.hpp"
#include "eigengrain/io/state_file.hpp"

#include "atomic_file.hpp"
#include "fingerprint.hpp"
#include "hdf5.hpp"
#include "seal.hpp"
#include "state_layout.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <cstring>
#include <ctime>
#include <string>
#include <type_traits>

namespace eigengrain::io {
namespace {

#ifdef __clang__
constexpr std::string_view compiler = __VERSION__;
#else
constexpr std::string_view compiler = "GCC " __VERSION__;
#endif

/// Bytes that the file will take at most: its numbers, and room for HDF5's own structures.
std::size_t largest_size(const assembly::State& state) {
  constexpr std::size_t body =
      sizeof(std::int64_t) + 7 * sizeof(Vec3) + 3 * sizeof(double) + sizeof(Quat) + 8;
  std::size_t size = (1U << 20U) + state.settings.document.size() + body * state.model.bodies.position.size();
  layout::for_each_own_column(state.model.bodies, [&](const char*, const auto& column) {
    size += (1U << 12U) + column.size() * (column.empty() ? 0 : sizeof(column[0]));
  });
  layout::for_each_clump_column(state.model.bodies.clumps, [&](const char*, const auto& column) {
    size += (1U << 12U) + column.size() * sizeof(column[0]);
  });
  if (state.guard) size += (1U << 14U) + (sizeof(Vec3) + 2 * sizeof(double)) * state.guard->position.size();
  for (const model::Group& group : state.groups)
    size += (1U << 14U) + group.balls.size() * sizeof(std::int64_t);
  state.model.contacts.for_each_group([&](const auto& group) {
    size += (1U << 14U) + group.pairs.size() * (sizeof(contact::Pair) + sizeof(group.states[0]));
  });
  return size;
}

void write_provenance(h5::File& file) {
  file.set(layout::root, "version", EIGENGRAIN_VERSION);
  file.set(layout::root, "written", fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr))));
  file.set(layout::root, "compiler", compiler);
  file.set(layout::root, "threads", std::int64_t{threads()});
}

void write_bodies(const assembly::State& state, h5::File& file) {
  file.add_group(layout::bodies);
  layout::for_each_column(state, [&](const std::string& path, const auto& column) {
    EIGENGRAIN_ASSERT(column.size() == state.model.bodies.position.size(), path, column.size());
    file.write(path, column);
  });
  if (!state.model.bodies.spin.empty()) file.write(layout::spin, state.model.bodies.spin);
  if (!state.model.bodies.orientation.empty())
    file.write(layout::orientation, state.model.bodies.orientation);
  if (!state.moment.empty()) file.write(layout::moment, state.moment);
  layout::for_each_own_column(state.model.bodies, [&](const std::string& path, const auto& column) {
    EIGENGRAIN_ASSERT(column.empty() || column.size() == state.model.bodies.position.size(), path);
    if (!column.empty()) file.write(path, column);
  });
}

void write_clumps(const model::Clumps& clumps, h5::File& file) {
  if (clumps.empty()) return;
  file.add_group(layout::clumps);
  layout::for_each_clump_column(
      clumps, [&](const std::string& path, const auto& column) { file.write(path, column); });
}

template <class Group>
void write_pairs(const Group& group, const std::string& path, h5::File& file) {
  std::vector<std::int32_t> first;
  std::vector<std::int32_t> second;
  std::vector<model::Image> image;
  for (const contact::Pair& pair : group.pairs) {
    first.push_back(pair.a);
    second.push_back(pair.b);
    image.push_back(pair.image);
  }
  file.write(path + "/a", first);
  file.write(path + "/b", second);
  file.write(path + "/image", image);
  if constexpr (std::is_same_v<typename Group::KinematicsType, contact::BallFacet>) {
    std::vector<std::int8_t> side;
    for (const contact::Pair& pair : group.pairs) side.push_back(pair.side);
    file.write(path + "/side", side);
  }
}

/// A state is plain doubles (contact/law.hpp): part after part is taken out of it.
template <class Group>
void write_states(const Group& group, const std::string& path, h5::File& file) {
  using State = typename Group::State;
  if constexpr (!std::is_empty_v<State>) {
    std::vector<double> values;
    contact::for_each_field<typename Group::LawType>(
        [&](const contact::StateField& field, std::size_t offset) {
          const auto components = static_cast<std::size_t>(field.components);
          values.resize(components * group.states.size());
          for (std::size_t c = 0; c < group.states.size(); ++c) {
            const auto bytes = std::as_bytes(std::span(&group.states[c], 1));
            std::memcpy(&values[components * c], &bytes[offset], components * sizeof(double));
          }
          file.write_rows(fmt::format("{}/{}", path, field.name), h5::Number::f64, values.data(),
                          group.states.size(), field.components);
        });
  }
}

void write_contacts(const contact::Contacts& contacts, h5::File& file) {
  file.add_group(layout::contacts);
  file.set(layout::contacts, "groups", static_cast<std::int64_t>(contacts.groups.size()));
  std::int64_t k = 0;
  contacts.for_each_group([&](const auto& group) {
    using Group = std::decay_t<decltype(group)>;
    const std::string path = layout::group(k++);
    file.add_group(path);
    file.set(path, "kinematics", Group::KinematicsType::name);
    file.set(path, "law", std::string_view(Group::LawType::name));
    file.set(path, "rule", std::int64_t{group.rule});
    file.set(path, "state_fields", layout::state_fields<typename Group::LawType>());
    write_pairs(group, path, file);
    write_states(group, path, file);
  });
}

/// Only where walls move.
void write_walls(const assembly::State& state, h5::File& file) {
  const auto& motions = state.model.wall_motions;
  if (motions.empty()) return;
  std::vector<std::int32_t> index;
  std::vector<Vec3> centre;
  std::vector<double> orientation;
  for (std::size_t m = 0; m < motions.size(); ++m) {
    const model::WallPose& pose = state.model.wall_poses[m];
    index.push_back(motions[m].wall);
    centre.push_back(pose.centre);
    const Eigen::Quaterniond& q = pose.orientation;
    orientation.insert(orientation.end(), {q.x(), q.y(), q.z(), q.w()});
  }
  file.add_group(layout::walls);
  file.write(layout::wall_index, index);
  file.write(layout::wall_centre, centre);
  file.write_rows(layout::wall_orientation, h5::Number::f64, orientation.data(), motions.size(), 4);
  file.set(layout::list, "wall_way", state.list.wall_way);
  file.write(layout::list_wall_lever, state.list.wall_lever);
}

/// Groups that were made, and how far the stages have come; only where there are any.
void write_stages(const assembly::State& state, h5::File& file) {
  if (!state.groups.empty()) file.add_group(layout::groups);
  for (std::size_t k = 0; k < state.groups.size(); ++k) {
    const std::string path = fmt::format("{}/{}", layout::groups, k);
    file.add_group(path);
    file.set(path, "name", state.groups[k].name);
    file.write(path + "/balls", state.groups[k].balls);
  }
  if (state.settings.stages.empty()) return;
  file.add_group(layout::progress);
  layout::for_each_progress(state.progress, [&](const char* name, auto value) {
    if constexpr (std::is_same_v<decltype(value), double>)
      file.set(layout::progress, name, value);
    else
      file.set(layout::progress, name, static_cast<std::int64_t>(value));
  });
}

/// Only where the step is tracked.
void write_guard(const assembly::State& state, h5::File& file) {
  if (!state.guard) return;
  file.add_group(layout::guard);
  layout::for_each_guard_number(*state.guard,
                                [&](const char* name, auto value) { file.set(layout::guard, name, value); });
  layout::for_each_guard_column(
      *state.guard, [&](const std::string& path, const auto& column) { file.write(path, column); });
}

/// A matrix as three rows.
void write_matrix(const Mat3& matrix, const std::string& path, h5::File& file) {
  const Mat3 rows = matrix.transpose();  // columns are contiguous
  file.write_rows(path, h5::Number::f64, rows.data(), 3, 3);
}

/// Only where the cell is not what the settings say.
void write_cell(const assembly::State& state, h5::File& file) {
  if (!layout::cell_has_moved(state)) return;
  file.add_group(layout::cell);
  write_matrix(state.model.cell.edges, layout::cell_edges, file);
  write_matrix(state.model.cell.rate, layout::cell_rate, file);
  write_matrix(state.list.edges, layout::list_cell_edges, file);
}

/// Which bodies are the nodes of deformable ones; their meshes the settings name.
void write_deformables(const std::vector<model::Deformable>& deformables, h5::File& file) {
  if (deformables.empty()) return;
  std::vector<std::int64_t> first_node;
  std::vector<std::int64_t> fingerprints;
  for (const model::Deformable& deformable : deformables) {
    first_node.push_back(deformable.first_node);
    fingerprints.push_back(fingerprint(deformable.mesh));
  }
  file.add_group(layout::deformables);
  file.write(layout::deformable_first_node, first_node);
  file.write(layout::deformable_fingerprint, fingerprints);
}

void write_contents(const assembly::State& state, h5::File& file) {
  file.set(layout::root, "format", layout::format);
  file.set(layout::root, "schema", layout::schema_of(state));
  write_provenance(file);
  file.set(layout::root, "scene", state.settings.name);
  layout::for_each_number(state, [&](const char* name, auto value) { file.set(layout::root, name, value); });
  file.write_text(layout::settings, state.settings.document);
  write_bodies(state, file);
  write_clumps(state.model.bodies.clumps, file);
  write_contacts(state.model.contacts, file);
  file.add_group(layout::list);
  file.set(layout::list, "skin", state.list.skin);
  file.set(layout::list, "rebuilds", state.list.rebuilds);
  if (!state.model.bodies.ramp.empty()) file.set(layout::list, "growth", state.list.growth);
  file.write(layout::list_position, state.list.position);
  write_cell(state, file);
  write_walls(state, file);
  if (!state.settings.surfaces.empty()) {
    file.add_group(layout::surfaces);
    file.write(layout::surface_fingerprint, fingerprints(state.settings.surfaces));
  }
  write_deformables(state.settings.deformables, file);
  if (state.ledger) {
    file.add_group(layout::ledger);
    layout::for_each_energy(*state.ledger, [&](const std::string& name, double energy) {
      file.set(layout::ledger, name.c_str(), energy);
    });
  }
  write_guard(state, file);
  write_stages(state, file);
}

}  // namespace

void write_state(const assembly::State& state, const std::filesystem::path& file) {
  if (state.settings.document.empty())
    throw InputError(
        {{file.string(), 0, "the state comes from no scene file, so there are no settings to write"}});
  AtomicFile part(file);
  const h5::Silence silence;
  try {
    h5::File hdf5 = h5::File::create_in_memory(largest_size(state));
    write_contents(state, hdf5);
    const std::span<const char> image = hdf5.image();
    part.write({image.data(), image.size()});
    const auto seal = seal_of(image);
    part.write({seal.data(), seal.size()});
  } catch (const h5::Error& error) {
    throw SolverError(fmt::format("{}: the state cannot be written: {}", file.string(), error.what()));
  }
  part.commit();
}

}  // namespace eigengrain::io
