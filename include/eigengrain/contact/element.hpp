#pragma once

#include "eigengrain/base/vec.hpp"
#include "eigengrain/contact/law.hpp"

#include <cstdint>

/// A contact as a finite element with one point: its factored stiffness K = BᵀDB.
namespace eigengrain::contact {

/// The body at an end that has no unknowns (a wall).
inline constexpr std::int32_t no_body = -1;

/// All that K needs of a contact: geometry (B) and stiffness (D).
struct ContactElement {
  std::int32_t a = no_body;  ///< body at the first end
  std::int32_t b =
      no_body;  ///< body at the second end, or no_body; equal to a for a body that touches its own image
  Vec3 normal = Vec3::Zero();
  Vec3 lever_a = Vec3::Zero();  ///< R_a, m
  Vec3 lever_b = Vec3::Zero();  ///< R_b, m
  ContactStiffness stiffness;
};

/// The dashpots of a contact beside its springs: c = 2β√(m k).
struct ContactDamping {
  double beta_n = 0;
  double beta_s = 0;
  double normal = 0;  ///< c along n, N s/m
  double shear = 0;   ///< c across n
};

/// K of a contact in 6×6 blocks on (u, θ) of its two ends; the block ba is the transpose of ab.
struct ContactBlocks {
  Mat6 aa;
  Mat6 ab;
  Mat6 bb;
};

/// B [6×12]: (δ, φ) = B (u_a, θ_a, u_b, θ_b), docs/theory.md:
///     B = [ -1  [R_a]×  1  -[R_b]× ]
///         [  0    -1    0     1    ]
Eigen::Matrix<double, 6, 12> strain_displacement(const ContactElement& element);

/// D [6×6], block diagonal: translation, rotation.
Mat6 elasticity(const ContactElement& element);

/// K = BᵀDB (PFC3D eqs. 1.37-1.44), written out in blocks instead of multiplied
ContactBlocks stiffness_blocks(const ContactElement& element);

/// The diagonal block of one end: B_iᵀ D B_i, with that end's lever. The same form for both ends.
Mat6 end_block(const ContactElement& element, const Vec3& lever);

/// K of a body that touches its own image: B = B_a + B_b on one set of unknowns, of which only the rotation
/// about the contact survives, (R_a - R_b) × θ.
Mat6 self_block(const ContactElement& element);

/// The same as one matrix [12×12] on (u_a, θ_a, u_b, θ_b). Symmetric, positive semidefinite, rank <= 6.
Mat12 stiffness_matrix(const ContactElement& element);

}  // namespace eigengrain::contact
