#pragma once

#include "eigengrain/assembly/model.hpp"
#include "eigengrain/contact/element.hpp"
#include "eigengrain/timestep/truth.hpp"

#include <cstdint>
#include <vector>

/// What limits the step: the modes of the largest eigenvalues, and who carries them.
namespace eigengrain::timestep {

/// Carriers of a mode are named until they have this part of its energy.
inline constexpr double carried_part = 0.9;

/// A body and its share of the kinetic energy of a mode. The share is what the step gains by the mass:
/// d ln dt/d ln m_i = ½ share.
struct CarryingBody {
  std::int32_t row = 0;  ///< of a clump its holder
  double share = 0;
};

/// A contact and its share of the elastic energy of a mode: d ln dt/d ln k_c = -½ share, all its stiffnesses
/// scaled alike.
struct CarryingContact {
  std::int32_t index = 0;  ///< element of the model's LinearSystem
  std::int32_t a = 0;      ///< row of the ball at the first side
  std::int32_t b = 0;      ///< that at the second, or contact::no_body
  std::int32_t wall = -1;  ///< where there is no second ball
  contact::ContactStiffness stiffness;
  double share = 0;
};

struct LimitingMode {
  double lambda = 0;         ///< s⁻²
  double dt = 0;             ///< 2/√λ, s
  double residual = 0;       ///< |A x - λ x| / |λ x| of A = M^-½ K M^-½
  double participation = 0;  ///< (Σ e_i)² / Σ e_i² of the kinetic energies: about so many bodies move
  double translation = 0;    ///< share of the kinetic energy in translations; the rest turns
  std::vector<CarryingBody> bodies;       ///< the largest shares first, to 0.9 of the whole
  std::vector<CarryingContact> contacts;  ///< likewise
  std::vector<double> energy;             ///< [bodies] e_i, of all one
  /// [bodies] u (m) and θ (rad, along the axes of space) of each body, for x·Mx = 1; of clumps in the row of
  /// the holder
  std::vector<Vec3> displacement, rotation;
};

struct LimitingModes {
  std::vector<LimitingMode> modes;  ///< the largest λ first; fewer than asked for where there are no more
  /// The undamped critical step with twice the mass of all carrying bodies, and with half the stiffness of
  /// all carrying contacts, computed anew, s.
  double dt_heavier = 0, dt_softer = 0;
  std::int32_t carrying_bodies = 0, carrying_contacts = 0;  ///< of all modes together
  double seconds = 0;
};

/// The `count` largest eigenpairs of K x = λ M x of the model as it stands (undamped), by Krylov-Schur
/// iteration on the matrix-free product, or as a dense matrix where it is small. Throws SolverError where
/// they do not converge.
LimitingModes limiting_modes(const assembly::Model& model, int count, const TruthOptions& options = {});

}  // namespace eigengrain::timestep
