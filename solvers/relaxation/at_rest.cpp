#include "at_rest.hpp"

#include "eigengrain/assembly/cell_motion.hpp"
#include "eigengrain/assembly/forces.hpp"

#include <utility>

namespace eigengrain::relaxation {
namespace {

using assembly::State;

constexpr double explicit_damping = 0.7;

}  // namespace

void halt(State& state) {
  for (Vec3& v : state.model.bodies.velocity) v.setZero();
  for (Vec3& w : state.model.bodies.spin) w.setZero();
  model::Clumps& clumps = state.model.bodies.clumps;
  for (Vec3& v : clumps.velocity) v.setZero();
  for (Vec3& w : clumps.spin) w.setZero();
  for (Vec3& l : clumps.angular_momentum) l.setZero();
  state.model.cell.rate.setZero();  // bodies have nothing of its flow any more
  state.dt = 0;
  assembly::forget_step(state);
  assembly::renew_forces(state);
}

SetAside::SetAside(State& state)
    : time_(state.time),
      step_(state.step),
      velocity_(state.model.bodies.velocity),
      spin_(state.model.bodies.spin),
      of_clumps_(state.model.bodies.clumps.velocity),
      clump_spin_(state.model.bodies.clumps.spin),
      timestep_(state.settings.timestep),
      mass_scaling_(std::exchange(state.settings.mass_scaling, {})),
      local_damping_(std::exchange(state.model.local_damping, explicit_damping)),
      damping_(std::exchange(state.model.bodies.damping, {})),
      mass_factor_(std::exchange(state.model.bodies.mass_factor, {})),
      ramp_(std::exchange(state.model.bodies.ramp, {})),
      velocity_gradient_(std::exchange(state.model.cell.velocity_gradient, Mat3::Zero())),
      wall_motions_(std::exchange(state.model.wall_motions, {})),
      wall_poses_(std::exchange(state.model.wall_poses, {})) {
  for (std::size_t m = 0; m < wall_motions_.size(); ++m) {
    if (!wall_motions_[m].servo) continue;
    model::WallMotion& servo = state.model.wall_motions.emplace_back(wall_motions_[m]);
    servo.time = {0.0};
    servo.velocity = {model::WallVelocity{}};
    servos_.push_back(m);
    state.model.wall_poses.push_back(wall_poses_[m]);
  }
  // The flow of the cell comes back with its first step.
  const assembly::Fluctuation fluctuation(state.model.cell);
  for (std::size_t i = 0; i < velocity_.size(); ++i)
    velocity_[i] = fluctuation.of(velocity_[i], state.model.bodies.position[i]);
  for (std::size_t c = 0; c < of_clumps_.size(); ++c)
    of_clumps_[c] = fluctuation.of(of_clumps_[c], state.model.bodies.clumps.position[c]);
}

void SetAside::give_back(State& state) {
  model::Bodies& bodies = state.model.bodies;
  for (std::size_t i = 0; i < velocity_.size(); ++i) {
    const model::FixedComponents fixed = bodies.fixed[i];
    bodies.velocity[i] = velocity_[i] - model::free_part(velocity_[i], fixed.translation());
    if (!spin_.empty()) bodies.spin[i] = spin_[i] - model::free_part(spin_[i], fixed.rotation());
  }
  model::Clumps& clumps = bodies.clumps;
  for (std::int32_t c = 0; c < clumps.size(); ++c) {
    const auto k = static_cast<std::size_t>(c);
    const model::FixedComponents fixed = bodies.fixed[static_cast<std::size_t>(clumps.holder(c))];
    clumps.velocity[k] = of_clumps_[k] - model::free_part(of_clumps_[k], fixed.translation());
    if (fixed.rotation() != 7) continue;
    clumps.spin[k] = clump_spin_[k];
    clumps.angular_momentum[k] = model::angular_momentum(clumps, c, clump_spin_[k]);
  }
  state.time = time_;
  state.step = step_;
  state.settings.timestep = timestep_;
  state.settings.mass_scaling = mass_scaling_;
  state.model.local_damping = local_damping_;
  bodies.damping = std::move(damping_);
  bodies.mass_factor = std::move(mass_factor_);
  bodies.ramp = std::move(ramp_);
  state.model.cell.velocity_gradient = velocity_gradient_;
  for (std::size_t s = 0; s < servos_.size(); ++s) wall_poses_[servos_[s]] = state.model.wall_poses[s];
  const bool other_walls = servos_.size() != wall_motions_.size();
  state.model.wall_motions = std::move(wall_motions_);
  state.model.wall_poses = std::move(wall_poses_);
  if (other_walls) state.list.wall_lever.clear();  // a list knows how far walls may move
}

}  // namespace eigengrain::relaxation
