#pragma once

#include "eigengrain/assembly/model.hpp"

#include <cstddef>
#include <type_traits>

namespace eigengrain::assembly {

/// Calls visit(group, c, geometry) for every contact c that acts at these places, group after group, in the
/// order of the contacts. Nothing is stored in the contacts. Cost O(contacts).
template <class Visit>
void for_each_acting(const Model& model, const contact::Placement& placement, const Visit& visit) {
  model.contacts.for_each_group([&](const auto& group) {
    using Kinematics = typename std::decay_t<decltype(group)>::KinematicsType;
    for (std::size_t c = 0; c < group.pairs.size(); ++c) {
      const contact::ContactGeometry geometry = Kinematics::geometry(placement, group.pairs[c]);
      if (group.law.acts(contact::at_rest(geometry), group.states[c])) visit(group, c, geometry);
    }
  });
}

/// The same where the bodies are.
template <class Visit>
void for_each_acting(const Model& model, const Visit& visit) {
  for_each_acting(model, model.placement(), visit);
}

}  // namespace eigengrain::assembly
