#pragma once

#include "eigengrain/assembly/state.hpp"

#include <string>

namespace eigengrain::relaxation {

struct NewtonOptions {
  double target = 1e-11;  ///< mean unbalanced ratio to stop at
  double reach = 0;       ///< up to which the state's contacts are listed, m
  int max_iterations = 30;
};

struct NewtonResult {
  bool converged = false;
  bool unfinished = false;  ///< not converged, but nearer: worth going on from a new list
  double ratio = 0;         ///< mean unbalanced ratio where it ended
  int iterations = 0;
  int linear_iterations = 0;
  std::string why;  ///< of an end without convergence, for the log
};

/// Newton's method (PETSc's SNES) for the equilibrium of the acting contacts, from the state as it stands:
/// trial displacements from the committed state, the consistent unsymmetric tangent, full steps, BiCGStab
/// with block ILU(0) on the 3×3 blocks. Floppy modes are held by a shift σM (pseudo-transient continuation
/// with switched evolution relaxation: Kelley and Keyes, SIAM J. Numer. Anal. 35:508, 1998): σ is the largest
/// acceleration that the residual gives a body over the longest step it may take, and vanishes with it. That
/// step doubles while the residual falls, and shrinks where it grows.
///
/// No body leaves what the list of contacts knows. Where the result is converged or unfinished, the
/// displacement is committed and forces are those of the new positions; otherwise the state is as it was.
NewtonResult newton(assembly::State& state, const NewtonOptions& options);

}  // namespace eigengrain::relaxation
