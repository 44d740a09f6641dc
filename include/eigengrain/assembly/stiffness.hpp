#pragma once

#include "eigengrain/assembly/clump_members.hpp"
#include "eigengrain/assembly/model.hpp"
#include "eigengrain/contact/bonds/bond.hpp"
#include "eigengrain/contact/element.hpp"
#include "eigengrain/contact/skin.hpp"

#include <concepts>
#include <type_traits>
#include <vector>

namespace eigengrain::assembly {

/// Whatever takes the stiffness of contacts one by one: a matrix, a list for a matrix-free product, bounds.
template <class S>
concept StiffnessSink = requires(S& sink, const contact::ContactElement& element) {
  sink.add(element);
};

/// Overlap over R* at which a contact that does not act yet is judged; only laws whose stiffness grows with
/// the overlap depend on it.
inline constexpr double typical_overlap = 1e-3;

/// Which of the listed contacts count: those that act now, or all, as if those that are near acted too.
enum class Listed { acting, all };

/// Whether a contact counts; its overlap becomes the one at which it is judged.
template <class Law>
bool counts(Listed which, const Law& law, const typename Law::State& state, contact::ContactMotion& motion) {
  if (law.acts(motion, state)) return true;
  motion.overlap = typical_overlap * motion.reduced_radius;
  return which == Listed::all;
}

/// Whether a listed pair can be an element at all: of the facets near a ball only those that it can touch
/// together, now, and of the bonds beside a law those that hold, as none ever acts again.
template <class Group>
bool is_element(const Group& group, std::size_t c) {
  if constexpr (std::is_same_v<typename Group::KinematicsType, contact::BallFacet>)
    return group.pairs[c].is_contact();
  else if constexpr (contact::is_beside_law<typename Group::LawType>)
    return group.states[c].bonded();
  else
    return true;
}

/// Calls visit(law, element), or visit(law, element, pair), for every contact that counts, group after group,
/// in the order of the contacts; but for those with skins of deformable bodies (for_each_skin_element). An
/// end at a ball of a clump is one at the clump's holder, with the lever from the clump's centre. Cost
/// O(contacts); nothing is allocated here.
template <class Visit>
void for_each_element(const Model& model, Listed which, const Visit& visit) {
  const contact::Placement placement = model.placement();
  model.contacts.for_each_group([&](const auto& group) {
    using Kinematics = typename std::decay_t<decltype(group)>::KinematicsType;
    for (std::size_t c = 0; c < group.pairs.size(); ++c) {
      if (!is_element(group, c) || contact::on_skin<Kinematics>(placement, group.pairs[c])) continue;
      const contact::ContactGeometry geometry = Kinematics::geometry(placement, group.pairs[c]);
      contact::ContactMotion motion = contact::at_rest(geometry);
      if (!counts(which, group.law, group.states[c], motion)) continue;
      contact::ContactElement element{
          .a = group.pairs[c].a,
          .b = Kinematics::second_is_body ? group.pairs[c].b : contact::no_body,
          .normal = geometry.normal,
          .lever_a = geometry.lever_a,
          .lever_b = geometry.lever_b,
          .stiffness = group.law.stiffness(motion, group.states[c]),
      };
      if (!model.bodies.clumps.empty()) {
        element.lever_a += lever_of(model.bodies, element.a);
        element.a = model.bodies.clumps.owner(element.a);
        if constexpr (Kinematics::second_is_body) {
          element.lever_b += lever_of(model.bodies, element.b);
          element.b = model.bodies.clumps.owner(element.b);
        }
      }
      if constexpr (std::is_invocable_v<const Visit&, decltype(group.law), const contact::ContactElement&,
                                        const contact::Pair&>)
        visit(group.law, element, group.pairs[c]);
      else
        visit(group.law, element);
    }
  });
}

/// The same for contacts with skins of deformable bodies: visit(law, element). The ball of a clump is its
/// holder.
template <class Visit>
void for_each_skin_element(const Model& model, Listed which, const Visit& visit) {
  if (model.solids.empty()) return;
  const contact::Placement placement = model.placement();
  model.contacts.for_each_group([&](const auto& group) {
    using Kinematics = typename std::decay_t<decltype(group)>::KinematicsType;
    if constexpr (std::is_same_v<Kinematics, contact::BallFacet>)
      for (std::size_t c = 0; c < group.pairs.size(); ++c) {
        if (!is_element(group, c) || !contact::on_skin<Kinematics>(placement, group.pairs[c])) continue;
        const contact::ContactGeometry geometry = Kinematics::geometry(placement, group.pairs[c]);
        contact::ContactMotion motion = contact::at_rest(geometry);
        if (!counts(which, group.law, group.states[c], motion)) continue;
        const std::int32_t ball = group.pairs[c].a;
        contact::SkinElement element{
            .element = {.a = model.bodies.clumps.owner(ball),
                        .normal = geometry.normal,
                        .lever_a = geometry.lever_a,
                        .lever_b = geometry.lever_b,
                        .stiffness = group.law.stiffness(motion, group.states[c])},
            .point = contact::skin_point(placement, group.pairs[c]),
        };
        if (!model.bodies.clumps.empty()) element.element.lever_a += lever_of(model.bodies, ball);
        visit(group.law, element);
      }
  });
}

/// Hands the elastic stiffness of every contact to the sink, in the order of the contacts. Does not know what
/// the sink fills.
template <StiffnessSink Sink>
void assemble_stiffness(const Model& model, Sink& sink, Listed which = Listed::acting) {
  for_each_element(model, which,
                   [&](const auto& /*law*/, const contact::ContactElement& element) { sink.add(element); });
}

/// The simplest sink: keeps the elements.
struct ElementList {
  std::vector<contact::ContactElement> elements;
  void add(const contact::ContactElement& element) { elements.push_back(element); }
};

/// The stiffness of the contacts as a list.
inline std::vector<contact::ContactElement> contact_elements(const Model& model,
                                                             Listed which = Listed::acting) {
  ElementList list;
  list.elements.reserve(static_cast<std::size_t>(model.contacts.size()));
  assemble_stiffness(model, list, which);
  return std::move(list.elements);
}

}  // namespace eigengrain::assembly
