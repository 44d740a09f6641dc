#pragma once

#include "eigengrain/assembly/model.hpp"

#include <cstdint>
#include <vector>

namespace eigengrain::spectrum {

/// Which springs of the contacts count.
enum class Springs {
  all,       ///< what the contacts have: along n, across it unless frictionless, and of rotations where they
             ///< resist it
  sticking,  ///< the same, but contacts that slide have the one along n only
  normal     ///< along n only: the frictionless count, with balls that do not turn
};

enum class SpringKind : std::uint8_t { normal, shear, twist, bending };

/// A row of √D B: one spring of one contact.
struct Spring {
  std::int32_t a = 0;   ///< row of the body at the first end; of a clump its holder
  std::int32_t b = -1;  ///< at the second, -1 at walls
  SpringKind kind = SpringKind::normal;
  Vec3 direction = Vec3::Zero();  ///< of the displacement, or axis of the rotation, that it resists
};

struct RigidityOptions {
  Springs springs = Springs::all;
  bool with_rattlers = true;  ///< else contacts of rattlers are left out, one after the other
  bool shapes = false;        ///< also the motions and the stresses themselves
};

/// Maxwell-Calladine: unknowns - springs = floppy - self_stress. Both on the right are found by
/// decompositions of their own, so that the equation is a check and no identity.
struct Rigidity {
  std::int64_t bodies = 0;     ///< that have unknowns
  std::int64_t rattlers = 0;   ///< balls, and clumps as a whole, with too few contacts to be held
  std::int64_t set_aside = 0;  ///< free bodies that no counted contact touches
  std::int64_t contacts = 0;   ///< counted
  std::int64_t unknowns = 0;   ///< free components
  std::int64_t floppy = 0;     ///< dimension of the null space of √D B, the trivial ones included
  std::int64_t trivial = 0;  ///< rigid motions of everything together among them: 6 where nothing holds it, 3
                             ///< in a cell that repeats along all axes
  std::int64_t self_stress = 0;  ///< dimension of the null space of its transpose
  std::vector<Spring> springs;   ///< the rows of √D B, those without stiffness left out

  /// Springs beyond what Maxwell's count asks for: springs - (unknowns - trivial); 0: isostatic.
  std::int64_t excess() const { return static_cast<std::int64_t>(springs.size()) - (unknowns - trivial); }
  /// Whether unknowns - springs = floppy - self_stress.
  bool counts_agree() const {
    return unknowns - static_cast<std::int64_t>(springs.size()) == floppy - self_stress;
  }

  /// [floppy][3 bodies] motions that no spring resists, u (m) and θ (rad, along the axes of space; of clumps
  /// in the row of the holder), with x·Mx = 1 and orthogonal in M; empty unless asked for.
  std::vector<std::vector<double>> floppy_u, floppy_theta;
  /// [self_stress][springs] forces (N) and moments (N m) of springs that balance on every free component,
  /// each over the root of its stiffness; orthogonal. Empty unless asked for.
  std::vector<std::vector<double>> stress;
  double floppy_residual = 0;  ///< largest |√D B x| of these over the largest singular value's bound
  double stress_residual = 0;  ///< largest |Bᵀ√D s| likewise
  double seconds = 0;
};

/// By two rank-revealing decompositions (SuiteSparseQR), of S = √D B M^-½ and of Sᵀ. What is below 1e-10 of
/// the norm of S counts as zero. For assemblies up to some thousand bodies; shapes take floppy × unknowns
/// numbers. Throws SolverError where the decomposition fails.
Rigidity rigidity(const assembly::Model& model, const RigidityOptions& options = {});

}  // namespace eigengrain::spectrum
