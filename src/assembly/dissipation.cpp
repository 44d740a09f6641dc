#include "eigengrain/assembly/dissipation.hpp"

#include "eigengrain/base/parallel.hpp"

#include "flat.hpp"

#include <cstdint>
#include <type_traits>
#include <vector>

namespace eigengrain::assembly {
namespace {

constexpr std::int64_t chunk_size = 1024;

template <class Law>
inline constexpr bool loses_energy = contact::DissipativeLaw<Law> || contact::BondLaw<Law>;

/// The force of springs alone; the loss of dashpots is counted by itself.
template <class Law>
contact::ContactForce of_springs(contact::ContactForce force, const typename Law::State& next) {
  if constexpr (contact::asks_rate<Law>) force.force -= next.viscous;
  return force;
}

/// What a bond has released that breaks here: its energy if it held less what is left, and the trapezoidal
/// work of the force that is missing, over the second half of the step. So it is the energy in the middle of
/// the step, as far as the cycle is concerned, and the balance closes as well as where nothing breaks.
template <class Law>
double released(const Law& law, const contact::MotionOf<Law>& motion, const typename Law::State& old,
                const typename Law::State& next, const contact::ContactForce& force,
                const contact::ContactMotion& way) {
  const Law holding = law.unbreakable();
  typename Law::State held;
  const contact::ContactForce before = of_springs<Law>(holding.evaluate(motion, old, held), held);
  const contact::ContactForce after = of_springs<Law>(force, next);
  return holding.energy(motion, old) - law.energy(motion, old) +
         0.5 * ((before.force - after.force).dot(way.displacement) +
                (before.moment - after.moment).dot(way.rotation));
}

template <class Group>
contact::Dissipation of_contact(const Group& group, std::size_t c, const contact::Placement& placement,
                                const Trial& trial) {
  using Kinematics = typename Group::KinematicsType;
  using Law = typename Group::LawType;
  using ContactState = typename Group::State;
  const contact::Pair& pair = group.pairs[c];
  const ContactState& old = group.states[c];
  contact::Dissipation lost;
  const contact::ContactGeometry geometry = Kinematics::geometry(placement, pair);
  const bool acts = group.law.acts(contact::at_rest(geometry), old);
  if constexpr (requires { old.formed(); })
    if (!acts && !old.formed()) return lost;
  const auto motion = motion_in<Kinematics>(group.law, placement, trial, pair, geometry);
  ContactState next;
  contact::ContactForce force;
  if (acts) force = group.law.evaluate(motion, old, next);
  if constexpr (contact::DissipativeLaw<Law>) lost = group.law.dissipation(motion, old, next);
  if constexpr (contact::BondLaw<Law>)
    if (old.bonded() && !next.bonded()) {
      contact::ContactMotion way;
      if constexpr (contact::in_total_form<Law>)
        way = contact::contact_motion(geometry, trial.side(pair.a), trial.side(pair.b, pair.image));
      else
        way = motion;
      lost.bonds += released(group.law, motion, old, next, force, way);
    }
  return lost;
}

}  // namespace

contact::Dissipation dissipation_in(const Model& model, const contact::Placement& placement,
                                    const Trial& trial) {
  contact::Dissipation total;
  model.contacts.for_each_group([&](const auto& group) {
    if constexpr (loses_energy<typename std::decay_t<decltype(group)>::LawType>) {
      std::vector<contact::Dissipation> parts(
          static_cast<std::size_t>((group.size() + chunk_size - 1) / chunk_size));
      const auto of_chunk = [&](std::int64_t begin, std::int64_t end, std::int64_t chunk) {
        contact::Dissipation part;
        for (auto c = static_cast<std::size_t>(begin); c < static_cast<std::size_t>(end); ++c)
          part += of_contact(group, c, placement, trial);
        parts[static_cast<std::size_t>(chunk)] = part;
      };
      using Group = std::decay_t<decltype(group)>;
      if constexpr (Group::KinematicsType::second_is_body && !contact::BondLaw<typename Group::LawType>)
        for_chunks(group.size(), chunk_size,
                   [&](std::int64_t begin, std::int64_t end, std::int64_t chunk)
                       EIGENGRAIN_FLAT { of_chunk(begin, end, chunk); });
      else
        for_chunks(group.size(), chunk_size, of_chunk);
      for (const contact::Dissipation& part : parts) total += part;
    }
  });
  return total;
}

}  // namespace eigengrain::assembly
