#pragma once

#include "eigengrain/assembly/model.hpp"
#include "eigengrain/contact/element.hpp"

#include <concepts>
#include <type_traits>
#include <vector>

namespace eigengrain::assembly {

/// Whatever takes the stiffness of contacts one by one: a matrix, a list for a matrix-free product, bounds.
template <class S>
concept StiffnessSink = requires(S& sink, const contact::ContactElement& element) {
  sink.add(element);
};

/// Which of the listed contacts count: those that act now, or all, as if those that are near acted too.
enum class Listed { acting, all };

/// Hands the elastic stiffness of every contact to the sink, group after group, in the order of the contacts.
/// Does not know what the sink fills. Cost O(contacts); nothing is allocated here.
template <StiffnessSink Sink>
void assemble_stiffness(const Model& model, Sink& sink, Listed which = Listed::acting) {
  const contact::Placement placement = model.placement();
  model.contacts.for_each_group([&](const auto& group) {
    using Kinematics = typename std::decay_t<decltype(group)>::KinematicsType;
    for (std::size_t c = 0; c < group.pairs.size(); ++c) {
      // Of the facets near a ball only those that it can touch together, now.
      if (std::is_same_v<Kinematics, contact::BallFacet> && !group.pairs[c].is_contact()) continue;
      const contact::ContactGeometry geometry = Kinematics::geometry(placement, group.pairs[c]);
      const contact::ContactMotion motion = contact::at_rest(geometry);
      if (which == Listed::acting && !group.law.acts(motion, group.states[c])) continue;
      sink.add(contact::ContactElement{
          .a = group.pairs[c].a,
          .b = Kinematics::second_is_body ? group.pairs[c].b : contact::no_body,
          .normal = geometry.normal,
          .lever_a = geometry.lever_a,
          .lever_b = geometry.lever_b,
          .stiffness = group.law.stiffness(motion, group.states[c]),
      });
    }
  });
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
