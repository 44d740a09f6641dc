#include "fire.hpp"

#include "eigengrain/assembly/clump_members.hpp"
#include "eigengrain/assembly/contact_list.hpp"
#include "eigengrain/assembly/loads.hpp"
#include "eigengrain/base/parallel.hpp"
#include "eigengrain/cycle/mass_scaling.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace eigengrain::relaxation {
namespace {

using assembly::Displacement;
using assembly::State;

constexpr int steps_before_growth = 5;
constexpr double growth = 1.1;
constexpr double retreat = 0.5;
constexpr double first_mixing = 0.1;
constexpr double mixing_decay = 0.99;
constexpr double first_step = 0.1;
constexpr double safety = 0.95;  // of the proven step
/// Where stiffnesses follow the overlap.
constexpr std::int64_t steps_between_masses = 100;
constexpr std::int64_t chunk_size = 1024;

/// Sums over bodies, chunk after chunk.
struct Sums {
  double power = 0;     ///< F·v
  double motion = 0;    ///< v·M v
  double push = 0;      ///< a·M a = F·a
  double farthest = 0;  ///< squared way from where the list was made, m²

  void add(const Sums& more) {
    power += more.power;
    motion += more.motion;
    push += more.push;
    // Not a number counts as infinitely far.
    if (!(more.farthest <= farthest)) farthest = more.farthest;
  }
};

template <class Visit>
Sums sum_over(std::int64_t bodies, const Visit& visit) {
  std::vector<Sums> chunks(static_cast<std::size_t>((bodies + chunk_size - 1) / chunk_size));
  for_chunks(bodies, chunk_size, [&](std::int64_t begin, std::int64_t end, std::int64_t chunk) {
    Sums sums;
    for (std::int64_t i = begin; i < end; ++i) visit(static_cast<std::size_t>(i), sums);
    chunks[static_cast<std::size_t>(chunk)] = sums;
  });
  Sums all;
  for (const Sums& sums : chunks) all.add(sums);
  return all;
}

/// I⁻¹ M of a body, rad/s².
Vec3 turned_by_moment(const model::Bodies& bodies, std::size_t row, const Vec3& moment) {
  const std::int32_t clump = bodies.clumps.of(static_cast<std::int32_t>(row));
  if (clump == model::Clumps::none) return moment / model::inertial_moment(bodies, row);
  const auto c = static_cast<std::size_t>(clump);
  const Quat& q = bodies.clumps.orientation[c];
  const Vec3 inertia = model::mass_factor_of(bodies, row) * bodies.clumps.inertia[c];
  return q * Vec3((q.conjugate() * moment).cwiseQuotient(inertia));
}

/// I ω of a body.
Vec3 angular_momentum_of(const model::Bodies& bodies, std::size_t row, const Vec3& spin) {
  const std::int32_t clump = bodies.clumps.of(static_cast<std::int32_t>(row));
  if (clump == model::Clumps::none) return model::inertial_moment(bodies, row) * spin;
  return model::mass_factor_of(bodies, row) * model::angular_momentum(bodies.clumps, clump, spin);
}

}  // namespace

Fire::Fire(State state)
    : scaling_(state.settings.mass_scaling),
      timestep_(state.settings.timestep),
      mass_factor_(state.model.bodies.mass_factor),
      forces_(state.model, state.turns()),
      dt_(first_step),
      mixing_(first_mixing) {
  state_ = std::move(state);
  state_.settings.mass_scaling = {.form = model::MassScaling::Form::differential, .dt = 1};
  state_.settings.timestep.safety = safety;
  choose_masses();
  const auto count = static_cast<std::size_t>(state_.model.bodies.size());
  for (Displacement* columns : {&rate_, &push_, &moved_}) {
    columns->translation.assign(count, Vec3::Zero());
    if (state_.turns()) columns->rotation.assign(count, Vec3::Zero());
  }
}

void Fire::choose_masses() {
  const double damping = std::exchange(state_.model.local_damping, 0.0);
  cycle::scale_masses(state_);
  state_.model.local_damping = damping;
}

State Fire::release() {
  state_.settings.mass_scaling = scaling_;
  state_.settings.timestep = timestep_;
  state_.model.bodies.mass_factor = std::move(mass_factor_);
  return std::move(state_);
}

void Fire::gather() {
  const model::Bodies& bodies = state_.model.bodies;
  pull_.force = state_.force;
  pull_.moment = state_.moment;
  if (!bodies.clumps.empty()) assembly::gather_members(bodies, {}, pull_);
}

void Fire::step() {
  gather();
  const model::Bodies& bodies = state_.model.bodies;
  const bool turns = state_.turns();
  const bool clumps = !bodies.clumps.empty();
  const Sums now = sum_over(bodies.size(), [&](std::size_t i, Sums& sums) {
    if (clumps && bodies.clumps.owner(static_cast<std::int32_t>(i)) != static_cast<std::int32_t>(i)) return;
    const model::FixedComponents fixed = bodies.fixed[i];
    const Vec3 force =
        model::free_part(pull_.force[i] + assembly::load_on(state_.model, i), fixed.translation());
    push_.translation[i] = force / model::inertial_mass(bodies, i);
    sums.power += force.dot(rate_.translation[i]);
    if (!turns) return;
    const Vec3 moment =
        model::free_part(pull_.moment[i] + assembly::moment_on(state_.model, i), fixed.rotation());
    push_.rotation[i] = turned_by_moment(bodies, i, moment);
    sums.power += moment.dot(rate_.rotation[i]);
  });
  const bool uphill = !(now.power > 0);
  if (uphill) {
    downhill_ = 0;
    mixing_ = first_mixing;
    dt_ *= retreat;
  } else if (++downhill_ > steps_before_growth) {
    dt_ = std::min(growth * dt_, 1.0);
    mixing_ *= mixing_decay;
  }
  if (dt_ < 1e-3 * first_step) dt_ = first_step;  // after a long way uphill, as on a cone of friction
  const Sums kicked = sum_over(bodies.size(), [&](std::size_t i, Sums& sums) {
    Vec3& v = rate_.translation[i];
    const Vec3& a = push_.translation[i];
    v = (uphill ? Vec3(Vec3::Zero()) : v) + dt_ * a;
    const double mass = model::inertial_mass(bodies, i);
    sums.motion += mass * v.squaredNorm();
    sums.push += mass * a.squaredNorm();
    if (!turns) return;
    Vec3& w = rate_.rotation[i];
    const Vec3& b = push_.rotation[i];
    w = (uphill ? Vec3(Vec3::Zero()) : w) + dt_ * b;
    sums.motion += w.dot(angular_momentum_of(bodies, i, w));
    sums.push += b.dot(angular_momentum_of(bodies, i, b));
  });
  const double along = kicked.push > 0 ? mixing_ * std::sqrt(kicked.motion / kicked.push) : 0.0;
  sum_over(bodies.size(), [&](std::size_t i, Sums&) {
    rate_.translation[i] = (1 - mixing_) * rate_.translation[i] + along * push_.translation[i];
    moved_.translation[i] = dt_ * rate_.translation[i];
    if (!turns) return;
    rate_.rotation[i] = (1 - mixing_) * rate_.rotation[i] + along * push_.rotation[i];
    moved_.rotation[i] = dt_ * rate_.rotation[i];
  });
  move();
  ++state_.step;
  if (state_.step % steps_between_masses == 0) choose_masses();
}

void Fire::move() {
  model::Bodies& bodies = state_.model.bodies;
  const Displacement* balls = &moved_;
  Displacement carried;
  if (!bodies.clumps.empty()) {
    carried = moved_;
    assembly::carry_members(bodies, carried);
    balls = &carried;
  }
  const Sums way = sum_over(bodies.size(), [&](std::size_t i, Sums& sums) {
    bodies.position[i] += balls->translation[i];
    const double squared = (bodies.position[i] - state_.list.position[i]).squaredNorm();
    if (!(squared <= sums.farthest)) sums.farthest = squared;
  });
  assembly::commit_clumps(bodies, moved_);
  bodies.orientation = assembly::turned_orientations(bodies, balls->rotation);
  const double room = 0.5 * state_.list.skin;
  if (!(way.farthest <= room * room)) {
    assembly::renew_list(state_, state_.list.skin);
    forces_ = assembly::ContactForceSum(state_.model, state_.turns());
    choose_masses();
  }
  assembly::BodyForces sum{std::move(state_.force), std::move(state_.moment)};
  forces_.advance(state_.model,
                  {bodies.position, balls->translation, balls->rotation, 1.0, bodies.orientation}, sum);
  state_.force = std::move(sum.force);
  state_.moment = std::move(sum.moment);
  if (!forces_.broken().empty()) assembly::note_breaks(state_, forces_.broken());
}

}  // namespace eigengrain::relaxation
