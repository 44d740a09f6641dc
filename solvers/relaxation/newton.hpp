#pragma once

#include "eigengrain/assembly/state.hpp"

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace eigengrain::relaxation {

struct NewtonOptions {
  double target = 1e-11;  ///< mean unbalanced ratio to stop at
  double reach = 0;       ///< up to which the state's contacts are listed, m
  int max_iterations = 30;
  /// It gives up where the least residual has not fallen to this part of what it was so many iterations ago.
  double progress = 0;  ///< 0: it does not
  int within = 5;
  /// Asked at every linear iteration: whether to give up; may be empty.
  std::function<bool()> interrupted{};
};

/// How far Newton's method is after an iteration.
struct NewtonMoment {
  double seconds = 0;       ///< since its start
  std::int64_t sweeps = 0;  ///< over the contacts: residuals, assemblies and products with the matrix
  double ratio = 0;         ///< mean unbalanced
};

struct NewtonResult {
  bool converged = false;
  bool unfinished = false;  ///< not converged, but nearer: worth going on from a new list
  double ratio = 0;         ///< mean unbalanced ratio where it ended
  int iterations = 0;
  int linear_iterations = 0;
  bool interrupted = false;
  std::vector<NewtonMoment> course;
  std::vector<std::string> linear_failures;  ///< of linear solvers, after which others took over
  std::string linear_method;                 ///< that solved the last system
  std::string why;                           ///< of an end without convergence, for the log
};

/// Newton's method (PETSc's SNES) for the equilibrium of the acting contacts, from the state as it stands:
/// trial displacements from the committed state, the consistent unsymmetric tangent, full steps,
/// linear solvers by size, contrast and symmetry (linear_solver.hpp). Floppy modes are held by a shift σM
/// (pseudo-transient continuation with switched evolution relaxation: Kelley and Keyes, SIAM J. Numer. Anal.
/// 35:508, 1998): σ is the largest acceleration that the residual gives a body over the longest step it may
/// take, and vanishes with it. That step doubles while the residual falls, and shrinks where it grows.
///
/// No body leaves what the list of contacts knows. Where the result is converged or unfinished, the
/// displacement is committed and forces are those of the new positions; otherwise the state is as it was.
NewtonResult newton(assembly::State& state, const NewtonOptions& options);

}  // namespace eigengrain::relaxation
