#include "soundness.hpp"

#include "eigengrain/assembly/acting.hpp"
#include "eigengrain/assembly/loads.hpp"
#include "eigengrain/base/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <type_traits>

namespace eigengrain::relaxation {
namespace {

using assembly::State;

/// Of the loads of a group, which cancel to rounding.
constexpr double rounding = 1e-12;

/// Disjoint sets of rows, by the least row in them.
class Groups {
 public:
  explicit Groups(std::int32_t rows) : parent_(static_cast<std::size_t>(rows)) {
    std::iota(parent_.begin(), parent_.end(), 0);
  }
  std::int32_t of(std::int32_t row) {
    while (parent_[row] != row) row = parent_[row] = parent_[parent_[row]];
    return row;
  }
  void join(std::int32_t a, std::int32_t b) {
    const std::int32_t first = of(a);
    const std::int32_t second = of(b);
    parent_[std::max(first, second)] = std::min(first, second);
  }

 private:
  std::vector<std::int32_t> parent_;
};

/// Loads of some bodies together, and what holds them.
struct Hold {
  Vec3 load = Vec3::Zero();
  double sum = 0;          ///< of the magnitudes, N
  std::uint8_t fixed = 0;  ///< components that some body is fixed in
  bool at_wall = false;
  std::int64_t bodies = 0;

  void add(const State& state, std::int32_t row) {
    const auto i = static_cast<std::size_t>(row);
    const Vec3 force = assembly::load_on(state.model, i);
    load += force;
    sum += force.norm();
    fixed = static_cast<std::uint8_t>(fixed | state.model.bodies.fixed[i].translation());
    ++bodies;
  }
  bool gives_way() const {
    if (at_wall) return false;
    for (int k = 0; k < 3; ++k)
      if (((fixed >> k) & 1) == 0 && std::abs(load[k]) > rounding * sum) return true;
    return false;
  }
};

template <class Visit>
void for_each_body(const model::Bodies& bodies, const Visit& visit) {
  for (std::int32_t row = 0; row < bodies.size(); ++row)
    if (bodies.clumps.owner(row) == row) visit(row);
}

}  // namespace

void require_numbers(const State& state) {
  const model::Bodies& bodies = state.model.bodies;
  const auto require = [&](const std::vector<Vec3>& values, const char* what) {
    for (std::size_t i = 0; i < values.size(); ++i)
      if (!values[i].allFinite())
        throw InputError(fmt::format(
            "ball {}: its {} is not a number ({}, {}, {}); take a state from before that happened",
            bodies.identity[i], what, values[i].x(), values[i].y(), values[i].z()));
  };
  require(bodies.position, "position");
  require(bodies.velocity, "velocity");
  require(bodies.spin, "spin");
  require(state.force, "force");
  require(state.moment, "moment");
}

std::vector<Floating> floating_groups(const State& state) {
  const model::Bodies& bodies = state.model.bodies;
  Groups groups(bodies.size());
  std::vector<char> at_wall(static_cast<std::size_t>(bodies.size()), 0);
  const contact::Placement placement = state.model.placement();
  assembly::for_each_acting(state.model, [&](const auto& group, std::size_t c, const auto& /*geometry*/) {
    const contact::Pair& pair = group.pairs[c];
    const std::int32_t a = bodies.clumps.owner(pair.a);
    using Kinematics = typename std::decay_t<decltype(group)>::KinematicsType;
    if constexpr (Kinematics::second_is_body)
      groups.join(a, bodies.clumps.owner(pair.b));
    else if (contact::on_skin<Kinematics>(placement, pair))
      groups.join(a, contact::skin_point(placement, pair).body[0]);
    else
      at_wall[a] = 1;
  });
  for (const auto& solid : state.model.solids)
    for (const std::int32_t row : solid->row) groups.join(solid->row.front(), row);
  std::vector<Hold> holds(static_cast<std::size_t>(bodies.size()));
  for_each_body(bodies, [&](std::int32_t row) {
    Hold& hold = holds[groups.of(row)];
    hold.add(state, row);
    hold.at_wall = hold.at_wall || at_wall[row] != 0;
  });
  std::vector<Floating> floating;
  for_each_body(bodies, [&](std::int32_t row) {
    if (groups.of(row) != row || !holds[row].gives_way()) return;
    floating.push_back({.bodies = holds[row].bodies, .first = bodies.identity[row]});
  });
  std::ranges::stable_sort(floating,
                           [](const Floating& l, const Floating& r) { return l.bodies > r.bodies; });
  return floating;
}

void require_support(const State& state) {
  if (!state.model.walls.empty() || !state.model.surfaces.empty()) return;
  Hold all;
  for_each_body(state.model.bodies, [&](std::int32_t row) { all.add(state, row); });
  if (!all.gives_way()) return;
  throw SolverError(
      fmt::format("there is no equilibrium: loads of ({:g}, {:g}, {:g}) N in all move the bodies, and the "
                  "scene has neither a "
                  "wall nor a body that is fixed in their direction; add one, or set gravity: [0, 0, 0]",
                  all.load.x(), all.load.y(), all.load.z()));
}

}  // namespace eigengrain::relaxation
