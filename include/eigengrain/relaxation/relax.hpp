#pragma once

#include "eigengrain/assembly/balance.hpp"
#include "eigengrain/assembly/state.hpp"

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

/// Quasi-static equilibrium.
namespace eigengrain::relaxation {

struct RelaxOptions {
  double tolerance = 1e-10;          ///< mean unbalanced ratio wished for
  std::int64_t max_steps = 1000000;  ///< explicit ones, those of parts included
  /// Called after every stage and every thousand explicit steps with a line to print; may be empty.
  std::function<void(const std::string&)> report;
  /// Asked between stages and every hundred explicit steps: whether to give up; may be empty.
  std::function<bool()> interrupted;
};

struct RelaxResult {
  bool converged = false;
  std::string method;  ///< "explicit", "newton" or "explicit+newton": what the end came from
  std::int64_t explicit_steps = 0;
  std::int64_t part_steps = 0;  ///< cycles of a few moving bodies by themselves
  int newton_iterations = 0;    ///< failed attempts included
  int linear_iterations = 0;
  int attempts = 0;  ///< of Newton's method
  assembly::Balance start;
  assembly::Balance end;  ///< as the explicit cycle evaluates it
  double seconds = 0;
  double explicit_seconds = 0;
};

/// Brings a state to the equilibrium nearest to where the damped motion leads: explicit cycles with local
/// damping 0.7 at the proven step until the ratio is small and nothing is unsupported, then Newton's method
/// on the same contact law. Where only a few bodies still roll or fall, they and their neighbours are cycled
/// by themselves while the others wait. Where Newton fails, explicit cycles go on to a tenth of the ratio.
/// The state is then at rest, with its clock where it was: the explicit cycle continues from it.
///
/// Friction admits many equilibria; this is one of them (docs/theory.md). Throws SolverError where PETSc
/// fails.
RelaxResult relax(assembly::State& state, const RelaxOptions& options = {});

}  // namespace eigengrain::relaxation
