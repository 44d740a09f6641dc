#pragma once

#include "eigengrain/contact/element.hpp"
#include "eigengrain/contact/law.hpp"

#include <cmath>
#include <cstddef>
#include <vector>

namespace eigengrain::assembly {

/// The dashpots of a contact beside its springs, c = 2β√(m k); none where its law has none.
///
/// mass  [bodies] kg
template <class Law>
contact::ContactDamping dashpots_of(const Law& law, const contact::ContactElement& element,
                                    const std::vector<double>& mass) {
  if constexpr (contact::asks_rate<Law>) {
    const double a = mass[static_cast<std::size_t>(element.a)];
    double reduced = a;
    if (element.b != contact::no_body) {
      const double b = mass[static_cast<std::size_t>(element.b)];
      reduced = a * b / (a + b);
    }
    const contact::DampingRatios beta = law.damping();
    return {.beta_n = beta.normal,
            .beta_s = beta.shear,
            .normal = 2 * beta.normal * std::sqrt(reduced * element.stiffness.normal),
            .shear = 2 * beta.shear * std::sqrt(reduced * element.stiffness.shear)};
  } else {
    return {};
  }
}

}  // namespace eigengrain::assembly
