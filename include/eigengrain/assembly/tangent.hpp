#pragma once

#include "eigengrain/assembly/acting.hpp"
#include "eigengrain/assembly/clump_tangent.hpp"
#include "eigengrain/assembly/forces.hpp"
#include "eigengrain/assembly/model.hpp"
#include "eigengrain/contact/consistent_tangent.hpp"
#include "eigengrain/contact/element.hpp"

#include <concepts>

namespace eigengrain::assembly {

/// Whatever takes consistent tangents one by one: bodies a and b (contact::no_body at a wall) and the 12×12
/// on (u_a, θ_a, u_b, θ_b), of which only the first 6×6 means anything at a wall. A clump is its holder, and
/// its θ is along its principal axes.
template <class S>
concept TangentSink = requires(S& sink, std::int32_t body, const Mat12& k) {
  sink.add(body, body, k);
};

/// Which branch of its law a contact is taken on.
enum class Slip {
  as_it_is,    ///< of the trial state: at rest even a contact at the limit of friction sticks
  continuing,  ///< contacts at the limit of friction slip on the way that they have slipped
  none         ///< all contacts stick: the elastic stiffness, with forces that turn with their contacts
};

/// A way on along the shear force, small, but enough for a contact at the limit of friction to slip.
template <class Law, class Motion, class State>
Motion slipping_on(const Law& law, Motion motion, const State& state, const Vec3& force) {
  constexpr double probe = 1e-6;  // of the shear force
  const double stiffness = law.stiffness(motion, state).shear;
  const Vec3 shear = force - force.dot(motion.normal) * motion.normal;
  if (stiffness > 0) motion.displacement -= probe / stiffness * shear;
  return motion;
}

/// Hands the consistent tangent of every contact that acts in the trial state to the sink, in the order of
/// the contacts: minus the derivative of ContactForceSum::evaluate, exact where the trial is the committed
/// state and up to the size of the increment over the radius elsewhere. Nothing is stored in the contacts.
template <TangentSink Sink>
void assemble_tangent(const Model& model, const Trial& trial, Sink& sink, Slip slip = Slip::as_it_is) {
  const contact::Placement placement = model.placement(trial.position, trial.orientation);
  for_each_acting(model, placement, [&](const auto& group, std::size_t c, const auto& geometry) {
    using Group = std::decay_t<decltype(group)>;
    using Kinematics = typename Group::KinematicsType;
    const contact::Pair& pair = group.pairs[c];
    if (contact::on_skin<Kinematics>(placement, pair)) return;  // nodal_stiffness.hpp
    const auto motion = motion_in<Kinematics>(group.law, placement, trial, pair, geometry);
    const std::int32_t second = Kinematics::second_is_body ? pair.b : contact::no_body;
    const auto force = [&] {
      typename Group::State discarded;
      return group.law.evaluate(motion, group.states[c], discarded);
    };
    const auto branch = [&] {
      if constexpr (!contact::in_total_form<typename Group::LawType>) {
        if (slip == Slip::none) {
          const contact::ContactStiffness k = group.law.stiffness(motion, group.states[c]);
          return contact::ContactTangent{.translation = k.translation(motion.normal),
                                         .rotation = k.rotation(motion.normal)};
        }
        if (slip == Slip::continuing)
          return group.law.tangent(slipping_on(group.law, motion, group.states[c], force().force),
                                   group.states[c]);
      }
      return group.law.tangent(motion, group.states[c]);
    };
    const auto tangent = branch();
    const auto add = [&](const Mat12& k) {
      if (model.bodies.clumps.empty()) return sink.add(pair.a, second, k);
      const ClumpTangent own = clump_tangent(model.bodies, trial, pair.a, second, k, force().force);
      sink.add(own.a, own.b, own.k);
    };
    if constexpr (contact::in_total_form<typename Group::LawType>)
      add(tangent);
    else
      add(contact::consistent_tangent(geometry, Kinematics::curvature(placement, pair, geometry), force(),
                                      tangent));
  });
}

}  // namespace eigengrain::assembly
