#pragma once

#include "eigengrain/assembly/linear_system.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace eigengrain::timestep {

/// What sums of some hundred products of positive semidefinite blocks may err by, relative: bounds are raised
/// by it.
inline constexpr double rounding_margin = 1e-12;

/// The factor P_i = D^½ B_i M_i^-½ of each end of a contact [6×6]. Its rows are along n and two directions
/// across it, for the relative displacement and then for the relative rotation; its columns are the body's
/// own (u, θ), zero where a component is fixed.
///
/// With P = (P_a, P_b) the scaled stiffness is M^-½ K M^-½ = Σ PᵀP, and P Pᵀ over all contacts is the
/// contact-space matrix G, which has the same eigenvalues but for zeros.
class ContactFactors {
 public:
  /// Refers to the system, which must outlive it.
  explicit ContactFactors(const assembly::LinearSystem& system);

  struct Ends {
    Mat6 a = Mat6::Zero();
    Mat6 b = Mat6::Zero();  ///< zero at walls, and where a body touches its own image: a has both ends then
  };
  Ends of(const contact::ContactElement& element) const;

  std::int64_t contacts() const { return static_cast<std::int64_t>(system_.elements.size()); }
  std::int32_t bodies() const { return static_cast<std::int32_t>(scale_.size()); }
  /// The bodies of a contact that can move: {a, b}, each or no_body.
  std::array<std::int32_t, 2> bodies_of(const contact::ContactElement& element) const;
  const assembly::LinearSystem& system() const { return system_; }

 private:
  Mat6 on_unknowns(std::int32_t body, Mat6 factor) const;

  const assembly::LinearSystem& system_;
  std::vector<Vec6> scale_;  ///< [bodies] the diagonal of M_i^-½, zero at components that are fixed
};

}  // namespace eigengrain::timestep
