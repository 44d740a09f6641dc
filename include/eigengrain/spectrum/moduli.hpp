#pragma once

#include "eigengrain/assembly/model.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace eigengrain::spectrum {

/// Systems up to this size have their stiffness factored, once for all six strains; larger ones are solved by
/// conjugate gradients on the matrix-free product.
inline constexpr std::int64_t factored_unknowns = 100000;

/// Elastic stiffness of an assembly in a cell that repeats along all axes: σ_i = C_ij ε_j in Voigt's order
/// xx, yy, zz, yz, xz, xy, with ε_yz and so on the whole shear angle.
struct Moduli {
  Mat6 stiffness = Mat6::Zero();     ///< C, Pa; symmetric
  Mat6 affine = Mat6::Zero();        ///< of bodies that follow the strain and do not turn (mean field), Pa
  double volume = 0;                 ///< of the cell, m³
  std::int64_t contacts = 0;         ///< acting
  std::array<double, 6> residual{};  ///< |A y - b| / |b| of each strain, A = M^-½ K M^-½; 0 where b is
  std::int64_t iterations = 0;       ///< of conjugate gradients, of all strains
  /// [6][bodies] what bodies move by beside the strain, m, and turn by, rad, for a strain of 1; of clumps in
  /// the row of the holder
  std::array<std::vector<Vec3>, 6> displacement, rotation;
  double seconds = 0;

  double bulk() const { return stiffness.topLeftCorner<3, 3>().sum() / 9; }  ///< Voigt's mean, Pa
  /// Voigt's mean of the shear modulus, Pa
  double shear() const {
    return ((stiffness(0, 0) + stiffness(1, 1) + stiffness(2, 2)) -
            (stiffness(0, 1) + stiffness(1, 2) + stiffness(0, 2)) +
            3 * (stiffness(3, 3) + stiffness(4, 4) + stiffness(5, 5))) /
           15;
  }
};

/// By linear response: with δ = ε ℓ at each contact (ℓ from centre to centre) and no motion of bodies beside
/// it, they are pushed by f = Bᵀ D δ; K u = -f lets them go to where they balance, and
///
///   C_ij = (Σ δ_i·D δ_j - f_i·K⁺f_j)/V.
///
/// f is in the range of K, so that floppy modes do not matter. K is the elastic stiffness: all contacts
/// stick, and what present forces add as contacts turn (of the size of the overlap over the radius) is left
/// out.
///
/// Throws InputError where the cell does not repeat along all axes, or some body is fixed, and SolverError
/// where the iteration does not converge.
Moduli elastic_moduli(const assembly::Model& model);

}  // namespace eigengrain::spectrum
