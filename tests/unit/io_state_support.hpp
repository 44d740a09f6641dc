#pragma once

#include "eigengrain/assembly/model.hpp"
#include "eigengrain/assembly/state.hpp"
#include "eigengrain/io/scene_reader.hpp"
#include "eigengrain/io/state_file.hpp"

#include "io/hdf5.hpp"
#include "io/seal.hpp"
#include "unit/io_support.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <fstream>
#include <functional>
#include <iterator>
#include <random>
#include <string>
#include <string_view>
#include <vector>

/// States with a bit of everything, and what is done to their files.
namespace eigengrain::io {

/// Balls on a loose lattice of a cell that repeats along x, on a floor, of four materials whose contacts have
/// friction, none, and tension; polygons lie in its walls; ice and ice do not see each other.
inline constexpr std::string_view busy_scene = R"(
gravity: [0, 0, -9.81 m/s2]
materials:
  - {name: sand, density: 2.65 g/cm3}
  - {name: ice, density: 917}
  - {name: "glue \"°\" \\", density: 1200}
  - {name: steel}
contacts:
  - {between: [sand, sand], law: linear, kn: 100 N/mm, ks: 5e4, friction: 0.5, end_step: true}
  - {between: [ice, ice], law: none}
  - {between: ["glue \"°\" \\", any], law: linear, kn: 1e5, ks: 2e4, tension: true}
  - {between: [any, any], law: linear, kn: 2e5}
balls:
  - {file: sand.txt, material: sand}
  - {file: ice.txt, material: ice, fix: [x, wy]}
  - {file: glue.txt, material: "glue \"°\" \\"}
walls:
  - {plane: {point: [0, 0, 0], normal: [0, 0, 3]}, material: steel}
  - {plane: {point: [0, 0, 0], normal: [0, 1, 0]}, material: sand}
  - {polygon: {corners: [[0, -1, 0], [0.06, -1, 0], [0.06, 1, 0], [0, 1, 0]]}, material: steel}
  - {polygon: {corners: [[0, 0, -1], [0, 0, 1], [0.06, 0, 1], [0.06, 0, -1]]}, material: sand}
periodic: {box: [0.06, 1, 1], axes: x}
damping: {local: 0.25}
timestep: {policy: fixed, dt: 10 us}
run: {steps: 10000, until: {unbalanced: 1e-5}}
)";

/// A packing of radius 5 mm balls on a lattice that overlaps a little, of layer z.
inline std::string layer(int z) {
  std::string text;
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 3; ++j)
      text += fmt::format("{} {} {} 0.005\n", 0.001 + 0.00999 * i, 0.0049 + 0.0099 * j, 0.0049 + 0.0099 * z);
  return text;
}

inline model::Scene busy(const std::vector<std::string>& overrides = {}) {
  const TemporaryFolder folder;
  folder.write("sand.txt", layer(0) + layer(1));
  folder.write("ice.txt", layer(2));
  folder.write("glue.txt", layer(3));
  return read_scene_text(busy_scene, folder.path(), "busy.yaml", overrides);
}

inline void randomize(std::vector<Vec3>& values, std::size_t count, std::mt19937_64& random) {
  std::normal_distribution<double> gaussian;
  values.resize(count);
  for (Vec3& value : values) value = {gaussian(random), 1e-300 * gaussian(random), -0.0};
}

/// A state that no cycle has made: every number is arbitrary, and so are the histories of contacts.
inline assembly::State arbitrary_state(const model::Scene& scene, bool turns = true) {
  std::mt19937_64 random(7);
  assembly::State state;
  state.settings = scene;
  state.settings.bodies = {};
  state.model = assembly::build_model(scene, 1e-4);
  const std::size_t count = state.model.bodies.position.size();
  randomize(state.model.bodies.velocity, count, random);
  randomize(state.force, count, random);
  randomize(state.list.position, count, random);
  if (turns) randomize(state.model.bodies.spin, count, random);
  if (turns) randomize(state.moment, count, random);
  state.model.contacts.for_each_group([&](auto& group) {
    for (auto& contact : group.states)
      if constexpr (requires { contact.shear; }) contact.shear = {1.0 / 3, -0.0, 1e-310};
  });
  state.list.skin = 0.1 + 0.2;
  state.list.edges = state.model.cell.edges;
  state.list.rebuilds = 12;
  state.time = 1.0 / 3;
  state.step = (std::int64_t{1} << 60) + 1;
  state.dt = 1e-5;
  state.next_dt = 1.1e-5;
  return state;
}

template <class T>
std::string bytes_of(const std::vector<T>& values) {
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)};
}
inline std::string bytes_of(double value) {
  return {reinterpret_cast<const char*>(&value), sizeof value};
}

/// All numbers of a state as bytes, and its settings by what their document says.
inline std::vector<std::string> bits(const assembly::State& state) {
  const model::Bodies& b = state.model.bodies;
  std::vector<std::string> all{bytes_of(b.identity),
                               bytes_of(b.position),
                               bytes_of(b.radius),
                               bytes_of(b.mass),
                               bytes_of(b.inertia),
                               bytes_of(b.material),
                               bytes_of(b.fixed),
                               bytes_of(b.velocity),
                               bytes_of(b.spin),
                               bytes_of(state.force),
                               bytes_of(state.moment),
                               bytes_of(state.list.skin),
                               bytes_of(state.list.position)};
  for (const double value : {state.time, state.dt, state.next_dt, state.model.local_damping})
    all.push_back(bytes_of(value));
  for (const std::int64_t value : {state.step, state.list.rebuilds}) all.push_back(std::to_string(value));
  all.push_back(bytes_of(std::vector{state.model.gravity, state.model.cell.origin}));
  const model::PeriodicCell& cell = state.model.cell;
  all.push_back(bytes_of(std::vector{cell.edges, cell.rate, cell.velocity_gradient, state.list.edges}));
  for (const bool axis : state.model.cell.periodic) all.emplace_back(axis ? "periodic" : "open");
  for (const model::Plane& wall : state.model.walls)
    all.push_back(wall.name + bytes_of(std::vector{wall.point, wall.normal}) + std::to_string(wall.material));
  for (const contact::AnyGroup& group : state.model.contacts.groups) {
    all.push_back(std::to_string(group.index()));
    std::visit(
        [&](const auto& concrete) {
          all.push_back(std::to_string(concrete.rule));
          for (const contact::Pair& pair : concrete.pairs)
            all.push_back(fmt::format("{} {} {} {} {} {}", pair.a, pair.b, pair.image[0], pair.image[1],
                                      pair.image[2], pair.side));
          if constexpr (!std::is_empty_v<typename std::decay_t<decltype(concrete)>::State>)
            all.push_back(bytes_of(concrete.states));
        },
        group);
  }
  all.push_back(state.settings.name);
  all.push_back(state.settings.document);
  for (const model::ContactRule& rule : state.settings.contacts)
    all.push_back(fmt::format("{} {} {} ", rule.first, rule.second, rule.law) + bytes_of(rule.parameters));
  return all;
}

/// What read_state says to a file; empty if it reads it.
inline std::string refusal(const std::filesystem::path& file,
                           const std::vector<std::string>& overrides = {}) {
  try {
    read_state(file, overrides);
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

inline std::string contents(const std::filesystem::path& file) {
  std::ifstream input(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(input), {}};
}

inline void seal(const std::filesystem::path& file) {
  const std::string text = contents(file);
  std::ofstream(file, std::ios::binary | std::ios::app) << seal_of(text);
}

/// Changes the HDF5 part of a state file and seals it again, as a program with a bug would have written it.
inline void rewrite(const std::filesystem::path& file, const std::function<void(hid_t)>& change) {
  const std::string text = contents(file);
  std::filesystem::resize_file(file, text.size() - 20);
  const hid_t id = H5Fopen(file.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  ASSERT_GE(id, 0);
  change(id);
  ASSERT_GE(H5Fclose(id), 0);
  seal(file);
}

}  // namespace eigengrain::io
