#pragma once

#include "eigengrain/assembly/bonds.hpp"
#include "eigengrain/base/parallel.hpp"

#include "support/motion.hpp"

#include <string>

/// Whether two states are the same to the bit.
namespace eigengrain::test {

/// Puts the number of threads back when it goes.
struct Threads {
  explicit Threads(int wanted) { set_threads(wanted); }
  Threads(const Threads&) = delete;
  Threads& operator=(const Threads&) = delete;
  ~Threads() { set_threads(before); }
  int before = threads();
};

/// All that moves in a state: balls, clumps, forces, shear, the number of bonds, walls, surfaces, and what
/// the near list was made for, and the proof of the step.
inline std::string bits_of(const assembly::State& state) {
  std::string bits;
  const auto add = [&](const auto& column) {
    bits.append(reinterpret_cast<const char*>(column.data()), column.size() * sizeof(column[0]));
  };
  add(state.model.bodies.position);
  add(state.model.bodies.velocity);
  add(state.model.bodies.spin);
  for (const Quat& q : state.model.bodies.orientation) add(q.coeffs());
  add(state.model.bodies.clumps.position);
  for (const Quat& q : state.model.bodies.clumps.orientation) add(q.coeffs());
  add(state.model.bodies.clumps.velocity);
  add(state.model.bodies.clumps.angular_momentum);
  add(state.model.bodies.clumps.spin);
  add(state.force);
  add(state.moment);
  add(shears_of(state));
  std::vector<std::int8_t> sides;
  for_each_shear(state.model, [&](const contact::Pair& pair, const auto&) { sides.push_back(pair.side); });
  add(sides);
  for (const model::Plane& wall : state.model.walls)
    add(std::vector<Vec3>{wall.point, wall.normal, wall.centre});
  for (const contact::SurfacePlace& place : state.model.surface_places) {
    add(std::vector<Vec3>{place.pose.centre});
    add(place.pose.orientation.coeffs());
  }
  add(std::vector<Mat3>{state.model.cell.edges, state.model.cell.rate, state.list.edges});
  add(std::vector<double>{state.time, state.list.wall_way});
  add(state.list.wall_lever);
  if (state.guard) {
    add(state.guard->position);
    add(state.guard->room);
    add(state.guard->weight);
    add(std::vector<double>{state.guard->dt, state.guard->wall_way, state.guard->gain});
  }
  bits += std::to_string(assembly::count_bonds(state.model));
  return bits;
}

}  // namespace eigengrain::test
