#include "clump_motion.hpp"

#include "eigengrain/assembly/clump_members.hpp"
#include "eigengrain/base/parallel.hpp"
#include "eigengrain/contact/orientation.hpp"
#include "eigengrain/cycle/free_rotation.hpp"

#include "kick.hpp"
#include "own_properties.hpp"

namespace eigengrain::cycle {
namespace {

/// Force on a clump and moment about its centre, of the contacts.
struct Resultant {
  Vec3 force = Vec3::Zero();
  Vec3 moment = Vec3::Zero();
};

Resultant resultant(const assembly::State& state, std::int32_t clump) {
  Resultant sum;
  for (const std::int32_t row : state.model.bodies.clumps.members(clump)) {
    const auto i = static_cast<std::size_t>(row);
    sum.force += state.force[i];
    sum.moment += state.moment[i] + assembly::lever_of(state.model.bodies, row).cross(state.force[i]);
  }
  return sum;
}

/// The moment with its local damping, which acts along the principal axes; where all axes are principal,
/// along those of space, as that of a ball does.
Vec3 damped_moment(const Vec3& moment, const Quat& axes, const Vec3& inertia, const Vec3& momentum,
                   double damping) {
  if (damping == 0) return moment;  // the detour through the axes would cost digits
  const bool round = inertia[0] == inertia[1] && inertia[1] == inertia[2];
  const Quat orientation = round ? Quat(Quat::Identity()) : axes;
  Vec3 own = orientation.conjugate() * moment;
  const Vec3 turning = orientation.conjugate() * momentum;
  for (int k = 0; k < 3; ++k) own[k] += assembly::local_damping_force(own[k], turning[k], damping);
  return orientation * own;
}

template <class Frame>
void move_clump(assembly::State& state, std::int32_t clump, double duration, double dt, const Frame& frame) {
  model::Bodies& bodies = state.model.bodies;
  model::Clumps& clumps = bodies.clumps;
  const auto c = static_cast<std::size_t>(clump);
  const auto holder = static_cast<std::size_t>(clumps.holder(clump));
  const EachItsOwn own(state.model);
  const double damping = own.damping(holder);
  const model::FixedComponents fixed = bodies.fixed[holder];
  const Resultant contacts = resultant(state, clump);

  Vec3& velocity = clumps.velocity[c];
  NoWork none(0, 0);  // scenes with clumps have no ledger
  kick(velocity, contacts.force + own.load(holder), own.mass(holder), duration, damping, fixed.translation(),
       none, FlowAt<Frame>(frame, clumps.position[c]));
  clumps.position[c] += dt * velocity;

  FreeRotation rotation;
  if (fixed.rotation() == 7) {
    rotation.theta = dt * clumps.spin[c];
    rotation.orientation = contact::turned(clumps.orientation[c], rotation.theta);
    rotation.turn = contact::turned(Quat::Identity(), rotation.theta);
  } else {
    Vec3& momentum = clumps.angular_momentum[c];
    // Of the true mass, also where masses are scaled: then moments are divided by the factor.
    const double scaled = bodies.mass_factor.empty() ? duration : duration / bodies.mass_factor[holder];
    momentum += scaled * damped_moment(own.with_applied(holder, contacts.moment), clumps.orientation[c],
                                       clumps.inertia[c], momentum, damping);
    rotation = rotate_freely(clumps.orientation[c], momentum, clumps.inertia[c], dt);
    clumps.spin[c] = rotation.theta / dt;
  }
  for (auto m = static_cast<std::size_t>(clumps.starts[c]);
       m < static_cast<std::size_t>(clumps.starts[c + 1]); ++m) {
    const auto i = static_cast<std::size_t>(clumps.member[m]);
    const Vec3 lever = clumps.orientation[c] * clumps.place[m];
    bodies.velocity[i] = velocity + model::turned_by(rotation.turn, lever) / dt;
    bodies.spin[i] = clumps.spin[c];
    bodies.position[i] = clumps.position[c] + rotation.orientation * clumps.place[m];
  }
  clumps.orientation[c] = rotation.orientation;
  if (fixed.rotation() == 7)
    clumps.angular_momentum[c] = model::angular_momentum(clumps, clump, clumps.spin[c]);
}

}  // namespace

template <class Frame>
void move_clumps(assembly::State& state, double duration, double dt, const Frame& frame) {
  constexpr std::int64_t chunk_size = 256;
  for_chunks(state.model.bodies.clumps.size(), chunk_size,
             [&](std::int64_t begin, std::int64_t end, std::int64_t) {
               for (auto clump = static_cast<std::int32_t>(begin); clump < end; ++clump)
                 move_clump(state, clump, duration, dt, frame);
             });
}

template void move_clumps(assembly::State&, double, double, const assembly::CellAtRest&);
template void move_clumps(assembly::State&, double, double, const assembly::MovingCell&);

}  // namespace eigengrain::cycle
