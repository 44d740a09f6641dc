#include "eigengrain/measures/ledger.hpp"

#include "eigengrain/assembly/clump_members.hpp"
#include "eigengrain/assembly/loads.hpp"
#include "eigengrain/assembly/local_damping.hpp"
#include "eigengrain/base/assert.hpp"
#include "eigengrain/base/error.hpp"
#include "eigengrain/base/parallel.hpp"

#include <cstdint>
#include <vector>

namespace eigengrain::measures {
namespace {

using assembly::State;

constexpr std::int64_t chunk_size = 1024;

/// Kinetic energy, and of the step behind the half of the work that counts with the forces at its end.
struct Motion {
  double kinetic = 0;
  assembly::EnergyIntegrals half;

  Motion& operator+=(const Motion& other) {
    kinetic += other.kinetic;
    half += other.half;
    return *this;
  }
  /// A body's velocity, or its spin if it is a ball.
  void add(const Vec3& velocity, const Vec3& force, double inertia, double dt, double alpha,
           std::uint8_t fixed) {
    for (int k = 0; k < 3; ++k) {
      const double v = velocity[k];
      if (((fixed >> k) & 1) != 0) {
        kinetic += 0.5 * inertia * v * v;
        half.prescribed -= 0.5 * dt * force[k] * v;
      } else {
        const double damping = assembly::local_damping_force(force[k], v, alpha);
        kinetic += 0.5 * v * (inertia * v + dt * (force[k] + damping));
        half.damping -= 0.5 * dt * damping * v;
      }
    }
  }
};

/// A clump, with its tensor of inertia as it lies at t.
void add_clump(const State& state, std::int32_t clump, Motion& motion) {
  const model::Bodies& bodies = state.model.bodies;
  const model::Clumps& clumps = bodies.clumps;
  const auto c = static_cast<std::size_t>(clump);
  const auto holder = static_cast<std::size_t>(clumps.holder(clump));
  const double alpha = assembly::damping_of(state.model, holder);
  const model::FixedComponents fixed = bodies.fixed[holder];
  const assembly::Resultant contacts = assembly::resultant_on(bodies, clump, state.force, state.moment);
  motion.add(clumps.velocity[c], contacts.force + assembly::load_on(state.model, holder), clumps.mass[c],
             state.dt, alpha, fixed.translation());
  const Vec3 moment = contacts.moment + assembly::moment_on(state.model, holder);
  const Vec3& momentum = clumps.angular_momentum[c];
  const Vec3 w = model::angular_velocity(clumps, clump);
  if (fixed.rotation() != 0) {
    motion.kinetic += 0.5 * w.dot(momentum);
    motion.half.prescribed -= 0.5 * state.dt * moment.dot(clumps.spin[c]);
    return;
  }
  const Vec3 resistance =
      assembly::local_damping_moment(moment, clumps.orientation[c], clumps.inertia[c], momentum, alpha);
  motion.kinetic += 0.5 * w.dot(momentum + state.dt * (moment + resistance));
  motion.half.damping -= 0.5 * state.dt * resistance.dot(clumps.spin[c]);
}

Motion motion_of(const State& state) {
  const model::Bodies& bodies = state.model.bodies;
  std::vector<Motion> parts(static_cast<std::size_t>((bodies.size() + chunk_size - 1) / chunk_size));
  for_chunks(bodies.size(), chunk_size, [&](std::int64_t begin, std::int64_t end, std::int64_t chunk) {
    Motion& part = parts[chunk];
    for (auto i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end); ++i) {
      if (const std::int32_t clump = bodies.clumps.of(static_cast<std::int32_t>(i));
          clump != model::Clumps::none) {
        if (bodies.clumps.holder(clump) == static_cast<std::int32_t>(i)) add_clump(state, clump, part);
        continue;
      }
      const model::FixedComponents fixed = bodies.fixed[i];
      const double alpha = assembly::damping_of(state.model, i);
      const Vec3 force = state.force[i] + assembly::load_on(state.model, i);
      part.add(bodies.velocity[i], force, bodies.mass[i], state.dt, alpha, fixed.translation());
      if (state.turns())
        part.add(bodies.spin[i], state.moment[i] + assembly::moment_on(state.model, i), bodies.inertia[i],
                 state.dt, alpha, fixed.rotation());
    }
  });
  Motion sum;
  for (const Motion& part : parts) sum += part;
  return sum;
}

double potential_of(const assembly::Model& model) {
  double sum = 0;
  for (std::size_t i = 0; i < model.bodies.position.size(); ++i)
    if (model.bodies.clumps.of(static_cast<std::int32_t>(i)) == model::Clumps::none)
      sum -= model.bodies.mass[i] * model.gravity.dot(model.bodies.position[i]);
  const model::Clumps& clumps = model.bodies.clumps;
  for (std::size_t c = 0; c < clumps.position.size(); ++c)
    sum -= clumps.mass[c] * model.gravity.dot(clumps.position[c]);
  return sum;
}

/// Laws of contacts with a shear spring, glued or not.
template <class Law>
constexpr bool shear_spring_of() {
  if constexpr (contact::BondLaw<Law>)
    return !contact::is_beside_law<Law>;
  else
    return requires(const typename Law::State& state) {
      state.shear;
    };
}
template <class Law>
inline constexpr bool has_shear_spring = shear_spring_of<Law>();

/// What a contact stores, spring by spring: its energy without the force of one spring after another.
template <class Law>
ElasticEnergy stored(const Law& law, const contact::Placement& placement, const contact::Pair& pair,
                     const contact::ContactGeometry& geometry, const typename Law::State& state) {
  const auto motion = contact::at_rest_for<Law>(placement, pair, geometry);
  const double all = law.energy(motion, state);
  if constexpr (has_shear_spring<Law>) {
    typename Law::State bare = state;
    double rolling = 0;
    if constexpr (requires { bare.moment; }) {
      bare.moment.setZero();
      rolling = all - law.energy(motion, bare);
    }
    bare.shear.setZero();
    const double normal = law.energy(motion, bare);
    return {.normal = normal, .shear = all - rolling - normal, .rolling = rolling};
  } else if constexpr (contact::BondLaw<Law>) {
    return {.bonds = all};
  } else {
    return {.normal = all};
  }
}

}  // namespace

ElasticEnergy elastic_energy(const assembly::Model& model) {
  ElasticEnergy energy{.elements = assembly::elastic_energy_of(model.solids, model.bodies.position),
                       .has_elements = !model.solids.empty()};
  const contact::Placement placement = model.placement();
  model.contacts.for_each_group([&](const auto& group) {
    using Kinematics = typename std::decay_t<decltype(group)>::KinematicsType;
    std::vector<ElasticEnergy> parts(static_cast<std::size_t>((group.size() + chunk_size - 1) / chunk_size));
    for_chunks(group.size(), chunk_size, [&](std::int64_t begin, std::int64_t end, std::int64_t chunk) {
      ElasticEnergy& part = parts[static_cast<std::size_t>(chunk)];
      for (auto c = static_cast<std::size_t>(begin); c < static_cast<std::size_t>(end); ++c) {
        const contact::Pair& pair = group.pairs[c];
        const contact::ContactGeometry geometry = Kinematics::geometry(placement, pair);
        if (group.law.acts(contact::at_rest(geometry), group.states[c]))
          part += stored(group.law, placement, pair, geometry, group.states[c]);
      }
    });
    for (const ElasticEnergy& part : parts) energy += part;
  });
  return energy;
}

Ledger ledger_of(const State& state) {
  EIGENGRAIN_ASSERT(state.ledger.has_value(), state.step);
  const Motion motion = motion_of(state);
  Ledger result{.kinetic = motion.kinetic,
                .elastic = measures::elastic_energy(state.model),
                .gravitational = potential_of(state.model),
                .integrals = state.ledger->integrals};
  result.integrals += motion.half;
  result.balance_error = result.kinetic + result.elastic.total() - state.ledger->initial;
  for (const assembly::EnergyIntegral& integral : assembly::energy_integrals)
    result.balance_error -= integral.sign * integral.of(result.integrals);
  return result;
}

std::vector<LedgerEntry> entries_of(const Ledger& ledger) {
  std::vector<LedgerEntry> entries{{"kinetic", ledger.kinetic},
                                   {"elastic_normal", ledger.elastic.normal},
                                   {"elastic_shear", ledger.elastic.shear},
                                   {"elastic_rolling", ledger.elastic.rolling},
                                   {"elastic_bonds", ledger.elastic.bonds},
                                   {"gravitational", ledger.gravitational}};
  if (ledger.elastic.has_elements) entries.push_back({"elastic_elements", ledger.elastic.elements});
  for (const assembly::EnergyIntegral& integral : assembly::energy_integrals)
    entries.push_back({std::string(integral.name), integral.of(ledger.integrals)});
  entries.push_back({"balance_error", ledger.balance_error});
  return entries;
}

void begin_ledger(State& state) {
  if (state.settings.mass_scaling)
    throw InputError(
        "histories: a ledger has no meaning where masses are scaled; leave `ledger` out of what the table "
        "holds, or remove mass_scaling");
  if (state.model.cell.deforms())
    throw InputError(
        "histories: the ledger does not count the work of a periodic cell that deforms, or did in the last "
        "step; leave `ledger` out of what the table holds (after one step with a velocity_gradient of zero "
        "it may begin)");
  const Motion motion = motion_of(state);
  const ElasticEnergy elastic = measures::elastic_energy(state.model);
  assembly::EnergyLedger ledger{.initial = motion.kinetic + elastic.total()};
  // The next kick adds the other half of the step behind as well, which is not this ledger's.
  ledger.integrals.damping = -motion.half.damping;
  ledger.integrals.prescribed = -motion.half.prescribed;
  state.ledger = ledger;
}

}  // namespace eigengrain::measures
