#pragma once

#include "eigengrain/assembly/forces.hpp"
#include "eigengrain/contact/dissipation.hpp"

namespace eigengrain::assembly {

/// What the contacts turn into heat on the way to a trial state, and what bonds release that break there, J.
/// The contacts have their states from before; which triangles of surfaces are contacts has been decided.
///
/// A pass of its own, and not a part of the sum of forces: that one stays as lean as it is where nobody asks.
/// Summed in fixed chunks of contacts. Cost: about one sum of forces.
contact::Dissipation dissipation_in(const Model& model, const contact::Placement& placement,
                                    const Trial& trial);

}  // namespace eigengrain::assembly
