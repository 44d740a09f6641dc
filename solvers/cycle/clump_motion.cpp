#include "clump_motion.hpp"

#include "eigengrain/assembly/clump_members.hpp"
#include "eigengrain/base/parallel.hpp"
#include "eigengrain/contact/orientation.hpp"
#include "eigengrain/cycle/free_rotation.hpp"

#include "own_properties.hpp"

#include <cstdint>
#include <vector>

namespace eigengrain::cycle {
namespace {

template <class Work, class Cell>
void move_clump(assembly::State& state, std::int32_t clump, double duration, double dt, const Cell& cell,
                Work& work) {
  model::Bodies& bodies = state.model.bodies;
  model::Clumps& clumps = bodies.clumps;
  const auto c = static_cast<std::size_t>(clump);
  const auto holder = static_cast<std::size_t>(clumps.holder(clump));
  const EachItsOwn own(state.model);
  const double damping = own.damping(holder);
  const model::FixedComponents fixed = bodies.fixed[holder];
  const assembly::Resultant contacts = assembly::resultant_on(bodies, clump, state.force, state.moment);

  Vec3& velocity = clumps.velocity[c];
  kick(velocity, contacts.force + own.load(holder), own.mass(holder), duration, damping, fixed.translation(),
       work, FlowAt<Cell>(cell, clumps.position[c]));
  work.gravity(clumps.mass[c] * state.model.gravity, velocity);
  clumps.position[c] += dt * velocity;

  const Vec3 moment = own.with_applied(holder, contacts.moment);
  FreeRotation rotation;
  if (fixed.rotation() == 7) {
    for (int k = 0; k < 3; ++k) work.held(moment[k], clumps.spin[c][k]);
    rotation.theta = dt * clumps.spin[c];
    rotation.orientation = contact::turned(clumps.orientation[c], rotation.theta);
    rotation.turn = contact::turned(Quat::Identity(), rotation.theta);
  } else {
    Vec3& momentum = clumps.angular_momentum[c];
    // Of the true mass, also where masses are scaled: then moments are divided by the factor.
    const double scaled = bodies.mass_factor.empty() ? duration : duration / bodies.mass_factor[holder];
    const Vec3 resistance =
        assembly::local_damping_moment(moment, clumps.orientation[c], clumps.inertia[c], momentum, damping);
    momentum += scaled * (moment + resistance);
    rotation = rotate_freely(clumps.orientation[c], momentum, clumps.inertia[c], dt);
    const Vec3 before = clumps.spin[c];
    clumps.spin[c] = rotation.theta / dt;
    work.resisted(resistance, before, clumps.spin[c]);
  }
  own.count_applied(holder, velocity, clumps.spin[c], work);
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

template <class Work, class Cell>
void move_clumps(assembly::State& state, double duration, double dt, const Cell& cell) {
  constexpr std::int64_t chunk_size = 256;
  const std::int64_t clumps = state.model.bodies.clumps.size();
  std::vector<assembly::EnergyIntegrals> works(
      Work::counts ? static_cast<std::size_t>((clumps + chunk_size - 1) / chunk_size) : 0);
  for_chunks(clumps, chunk_size, [&](std::int64_t begin, std::int64_t end, std::int64_t chunk) {
    Work work(state.dt, dt);
    for (auto clump = static_cast<std::int32_t>(begin); clump < end; ++clump)
      move_clump(state, clump, duration, dt, cell, work);
    if constexpr (Work::counts) works[static_cast<std::size_t>(chunk)] = work.sum;
  });
  for (const assembly::EnergyIntegrals& work : works) state.ledger->integrals += work;
}

template void move_clumps<NoWork>(assembly::State&, double, double, const assembly::CellAtRest&);
template void move_clumps<NoWork>(assembly::State&, double, double, const assembly::CellStep&);
template void move_clumps<KickWork>(assembly::State&, double, double, const assembly::CellAtRest&);

}  // namespace eigengrain::cycle
