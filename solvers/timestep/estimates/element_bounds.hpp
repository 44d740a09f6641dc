#pragma once

#include "timestep/estimates/contact_factors.hpp"

/// Bounds by elements (Irons and Treharne 1971, Irons and Fried 1971): the masses are divided among the
/// contacts of a body, and λ_max is at most the largest eigenvalue of any contact with its part of the
/// masses.
namespace eigengrain::timestep {

/// How a body's mass (and inertia) is divided among its contacts.
enum class MassSplit {
  equal,        ///< the same for each
  by_stiffness  ///< in proportion to λ_max of the contact on the body alone
};

/// Step by the element bound, s.
double element_bound(const ContactFactors& factors, MassSplit split);

/// The best division that `sweeps` of an iteration find, s. Every sweep is a bound, and none is worse than
/// the one before (docs/theory.md).
double best_element_bound(const ContactFactors& factors, int sweeps);

}  // namespace eigengrain::timestep
