#include "eigengrain/cycle/watch.hpp"

#include "eigengrain/assembly/body_size.hpp"
#include "eigengrain/assembly/cell_motion.hpp"
#include "eigengrain/assembly/energies.hpp"
#include "eigengrain/assembly/loads.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace eigengrain::cycle {
namespace {

using assembly::State;

constexpr std::size_t most_named = 5;
constexpr double largest_overlap = 0.5;   // of the smaller radius
constexpr double largest_way = 0.1;       // of the radius, in a step
constexpr double largest_growth = 100.0;  // of the energy that can be explained

/// Bodies with a number that tells how bad they are.
class Ranking {
 public:
  void add(double badness, std::int64_t identity) { rows_.emplace_back(badness, identity); }
  bool empty() const { return rows_.empty(); }
  double worst() {
    sort();
    return rows_.front().first;
  }
  std::vector<std::int64_t> bodies() {
    sort();
    std::vector<std::int64_t> result;
    for (const auto& [badness, identity] : rows_)
      if (result.size() < most_named && std::find(result.begin(), result.end(), identity) == result.end())
        result.push_back(identity);
    return result;
  }

 private:
  void sort() {
    std::sort(rows_.begin(), rows_.end(), [](const auto& l, const auto& r) {
      return l.first != r.first ? l.first > r.first : l.second < r.second;
    });
  }
  std::vector<std::pair<double, std::int64_t>> rows_;
};

std::optional<Trouble> not_finite(const State& state) {
  Ranking bad;
  const model::Bodies& bodies = state.model.bodies;
  for (std::size_t i = 0; i < bodies.position.size(); ++i)
    if (!bodies.position[i].allFinite() || !bodies.velocity[i].allFinite() || !state.force[i].allFinite())
      bad.add(0, bodies.identity[i]);
  if (bad.empty()) return std::nullopt;
  return Trouble{"not a number: a position, velocity or force is not finite", bad.bodies()};
}

std::optional<Trouble> too_fast(const State& state) {
  Ranking bad;
  const model::Bodies& bodies = state.model.bodies;
  const assembly::Fluctuation fluctuation(state.model.cell);
  // The flow of a cell takes neighbours past each other, each by this part of its radius at most.
  const double strain = state.model.cell.flow_gradient().norm() * state.dt;
  for (std::size_t i = 0; i < bodies.position.size(); ++i) {
    const Vec3 velocity = fluctuation.of(bodies.velocity[i], bodies.position[i]);
    const double way =
        velocity.norm() * state.dt / assembly::size_of(bodies, static_cast<std::int32_t>(i)) + strain;
    if (way > largest_way) bad.add(way, bodies.identity[i]);
  }
  if (bad.empty()) return std::nullopt;
  const double worst = bad.worst();
  return Trouble{fmt::format("speed: a ball moves by {:.3g} of its radius in one step", worst), bad.bodies()};
}

std::optional<Trouble> too_deep(const State& state) {
  Ranking bad;
  const model::Bodies& bodies = state.model.bodies;
  const contact::Placement placement = state.model.placement();
  state.model.contacts.for_each_group([&](const auto& group) {
    using Kinematics = typename std::decay_t<decltype(group)>::KinematicsType;
    for (const contact::Pair& pair : group.pairs) {
      double radius = bodies.radius[pair.a] > 0 ? bodies.radius[pair.a] : assembly::size_of(bodies, pair.a);
      if constexpr (Kinematics::second_is_body) radius = std::min(radius, bodies.radius[pair.b]);
      const double depth = Kinematics::geometry(placement, pair).overlap / radius;
      if (!(depth > largest_overlap)) continue;
      bad.add(depth, bodies.identity[pair.a]);
      if constexpr (Kinematics::second_is_body) bad.add(depth, bodies.identity[pair.b]);
    }
  });
  if (bad.empty()) return std::nullopt;
  const double worst = bad.worst();
  return Trouble{fmt::format("overlap: {:.3g} of the smaller radius", worst), bad.bodies()};
}

Trouble energy_trouble(const State& state, double found, double explained) {
  Ranking fastest;
  const model::Bodies& bodies = state.model.bodies;
  for (std::size_t i = 0; i < bodies.position.size(); ++i)
    fastest.add(bodies.velocity[i].squaredNorm() * bodies.mass[i], bodies.identity[i]);
  return {fmt::format("energy: kinetic and elastic energy of {:.3g} J, where {:.3g} J can be explained",
                      found, explained),
          fastest.bodies()};
}

/// Whether the state holds all that can give energy to its bodies.
bool closed(const State& state) {
  const assembly::Model& model = state.model;
  if (model.cell.deforms()) return false;
  for (int k = 0; k < 3; ++k)
    if (model.cell.periodic[k] && model.gravity[k] != 0) return false;
  if (!model.wall_motions.empty()) return false;
  const model::Bodies& bodies = model.bodies;
  if (assembly::has_loads(bodies) || !bodies.ramp.empty() || !bodies.mass_factor.empty()) return false;
  const model::Clumps& clumps = bodies.clumps;
  for (std::int32_t c = 0; c < clumps.size(); ++c)
    for (int k = 0; k < 3; ++k) {
      const model::FixedComponents fixed = bodies.fixed[static_cast<std::size_t>(clumps.holder(c))];
      if (fixed.component(k) && clumps.velocity[static_cast<std::size_t>(c)][k] != 0) return false;
      if (fixed.component(k + 3) && clumps.spin[static_cast<std::size_t>(c)][k] != 0) return false;
    }
  for (std::size_t i = 0; i < bodies.position.size(); ++i)
    for (int k = 0; k < 3; ++k) {
      if (clumps.of(static_cast<std::int32_t>(i)) != model::Clumps::none) break;
      if (bodies.fixed[i].component(k) && bodies.velocity[i][k] != 0) return false;
      if (state.turns() && bodies.fixed[i].component(k + 3) && bodies.spin[i][k] != 0) return false;
    }
  return true;
}

}  // namespace

Watch::Watch(const State& state) : closed_(closed(state)) {
  const assembly::Energies energies = assembly::energies_of(state);
  available_ = energies.kinetic + energies.elastic;
  gravitational_ = energies.gravitational;
}

std::optional<Trouble> Watch::look(const State& state) {
  if (auto trouble = not_finite(state)) return trouble;
  if (auto trouble = too_deep(state)) return trouble;
  if (auto trouble = too_fast(state)) return trouble;
  if (!closed_) return std::nullopt;
  const assembly::Energies energies = assembly::energies_of(state);
  const double found = energies.kinetic + energies.elastic;
  // A ball may bounce a little higher than it began: it then has energy, and nothing is released any more.
  released_ = std::max(released_, gravitational_ - energies.gravitational);
  const double explained = available_ + released_;
  if (!(found <= largest_growth * explained)) return energy_trouble(state, found, explained);
  return std::nullopt;
}

}  // namespace eigengrain::cycle
