#include "newton.hpp"

#include "eigengrain/base/timer.hpp"
#include "eigengrain/petsc/session.hpp"

#include "equations.hpp"
#include "linear_solver.hpp"

#include <fmt/format.h>
#include <petscsnes.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <utility>
#include <vector>

namespace eigengrain::relaxation {
namespace {

using assembly::State;
using petsc::Vector;
using Solver = petsc::Owner<SNES, SNESDestroy>;

/// What SNES calls back. An exception must not cross C: it is kept and thrown again outside.
struct Context {
  Equations& equations;
  const NewtonOptions& options;
  LinearSolver& linear;
  double first_ratio = 0;
  double ratio = 0;
  double ratio_before = 0;  ///< of the iteration before
  int linear_iterations = 0;
  Stopwatch watch{};
  std::int64_t sweeps = 0;
  std::vector<NewtonMoment> course{};
  bool out_of_room = false;
  bool unsolved = false;  ///< no linear solver found the last step
  std::string linear_method{};
  std::vector<std::string> linear_failures{};
  std::exception_ptr failure{};

  bool stands_still() const {
    const auto within = static_cast<std::size_t>(options.within);
    if (options.progress == 0 || course.size() <= within) return false;
    const auto least = [&](std::size_t count) {
      return std::ranges::min_element(course.begin(), course.begin() + static_cast<std::ptrdiff_t>(count), {},
                                      &NewtonMoment::ratio)
          ->ratio;
    };
    return least(course.size()) > options.progress * least(course.size() - within);
  }

  template <class Call>
  PetscErrorCode guarded(const Call& call) {
    try {
      call();
      return 0;
    } catch (...) {
      failure = std::current_exception();
      return PETSC_ERR_LIB;
    }
  }
};

PetscErrorCode form_residual(SNES /*solver*/, Vec x, Vec r, void* context) {
  auto& c = *static_cast<Context*>(context);
  return c.guarded([&] {
    c.equations.residual(x, r);
    ++c.sweeps;
  });
}

PetscErrorCode form_jacobian(SNES solver, Vec /*x*/, Mat /*jacobian*/, Mat /*preconditioner*/,
                             void* context) {
  auto& c = *static_cast<Context*>(context);
  return c.guarded([&] {
    Vec r = nullptr;
    EIGENGRAIN_PETSC(SNESGetFunction(solver, &r, nullptr, nullptr));
    c.equations.assemble(r);
    c.linear.matrix_changed();
    ++c.sweeps;
  });
}

/// As exactly as it pays: the next residual is not much smaller than the square of this one anyway (Eisenstat
/// and Walker, SIAM J. Sci. Comput. 17:16, 1996, choice 2).
double linear_tolerance(const Context& c) {
  constexpr double loosest = 1e-2;
  constexpr double tightest = 1e-6;
  if (c.ratio_before == 0) return loosest;
  const double part = c.ratio / c.ratio_before;
  // No more than the end asks for.
  const double enough = 0.1 * c.options.target / c.ratio;
  return std::min(loosest, std::max({0.1 * part * part, enough, tightest}));
}

PetscErrorCode solve_linear(PC preconditioner, Vec b, Vec x) {
  void* context = nullptr;
  PetscCall(PCShellGetContext(preconditioner, &context));
  auto& c = *static_cast<Context*>(context);
  return c.guarded([&] {
    LinearOutcome outcome = c.linear.solve(b, x, linear_tolerance(c));
    c.linear_iterations += outcome.iterations;
    c.sweeps += outcome.products;
    c.unsolved = !outcome.solved;
    if (outcome.solved) c.linear_method = name_of(outcome.method);
    for (std::string& failure : outcome.failures) c.linear_failures.push_back(std::move(failure));
  });
}

PetscErrorCode keep_within_list(SNESLineSearch /*search*/, Vec x, Vec y, PetscBool* changed, void* context) {
  auto& c = *static_cast<Context*>(context);
  return c.guarded([&] {
    const bool limited = c.equations.limit(x, y);
    c.out_of_room = c.out_of_room || limited;
    *changed = limited ? PETSC_TRUE : PETSC_FALSE;
  });
}

PetscErrorCode test_convergence(SNES solver, PetscInt iteration, PetscReal, PetscReal, PetscReal,
                                SNESConvergedReason* reason, void* context) {
  auto& c = *static_cast<Context*>(context);
  return c.guarded([&] {
    constexpr double hopeless = 30;
    Vec r = nullptr;
    EIGENGRAIN_PETSC(SNESGetFunction(solver, &r, nullptr, nullptr));
    const double before = c.ratio_before = c.ratio;
    c.ratio = c.equations.ratio(r);
    c.course.push_back({.seconds = c.watch.seconds(), .sweeps = c.sweeps, .ratio = c.ratio});
    if (iteration == 0)
      c.first_ratio = c.ratio;
    else
      c.equations.adapt_step(before, c.ratio);
    *reason = SNES_CONVERGED_ITERATING;
    if (c.ratio <= c.options.target)
      *reason = SNES_CONVERGED_FNORM_ABS;
    else if (c.unsolved)
      *reason = SNES_DIVERGED_LINEAR_SOLVE;
    else if (c.stands_still())
      *reason = SNES_DIVERGED_MAX_IT;
    else if (!std::isfinite(c.ratio) || c.ratio > hopeless * c.first_ratio)
      *reason = SNES_DIVERGED_DTOL;
  });
}

Solver new_solver(Context& context) {
  Solver solver;
  EIGENGRAIN_PETSC(SNESCreate(PETSC_COMM_SELF, solver.put()));
  EIGENGRAIN_PETSC(SNESSetOptionsPrefix(solver.get(), "relax_"));
  EIGENGRAIN_PETSC(SNESSetType(solver.get(), SNESNEWTONLS));
  EIGENGRAIN_PETSC(SNESSetFunction(solver.get(), nullptr, form_residual, &context));
  const Mat jacobian = context.equations.jacobian();
  EIGENGRAIN_PETSC(SNESSetJacobian(solver.get(), jacobian, jacobian, form_jacobian, &context));
  EIGENGRAIN_PETSC(SNESSetConvergenceTest(solver.get(), test_convergence, &context, nullptr));
  EIGENGRAIN_PETSC(SNESSetTolerances(solver.get(), 0, 0, 0, context.options.max_iterations, 100000));
  SNESLineSearch search = nullptr;
  EIGENGRAIN_PETSC(SNESGetLineSearch(solver.get(), &search));
  EIGENGRAIN_PETSC(SNESLineSearchSetType(search, SNESLINESEARCHBASIC));
  EIGENGRAIN_PETSC(SNESLineSearchSetPreCheck(search, keep_within_list, &context));
  KSP linear = nullptr;
  PC preconditioner = nullptr;
  EIGENGRAIN_PETSC(SNESGetKSP(solver.get(), &linear));
  EIGENGRAIN_PETSC(KSPSetOptionsPrefix(linear, "relax_chain_"));  // "relax_" is that of the first in it
  EIGENGRAIN_PETSC(KSPSetType(linear, KSPPREONLY));
  EIGENGRAIN_PETSC(KSPGetPC(linear, &preconditioner));
  EIGENGRAIN_PETSC(PCSetType(preconditioner, PCSHELL));
  EIGENGRAIN_PETSC(PCShellSetContext(preconditioner, &context));
  EIGENGRAIN_PETSC(PCShellSetApply(preconditioner, solve_linear));
  EIGENGRAIN_PETSC(SNESSetFromOptions(solver.get()));
  return solver;
}

}  // namespace

NewtonResult newton(State& state, const NewtonOptions& options) {
  petsc::start();
  Equations equations(state, options.reach);
  LinearSolver linear(equations.jacobian(), {.contrast = equations.contrast(),
                                             .rigid_motions = [&] { return equations.rigid_motions(); },
                                             .interrupted = options.interrupted,
                                             .prefix = "relax_"});
  Context context{equations, options, linear};
  const Solver solver = new_solver(context);
  Vector x;
  EIGENGRAIN_PETSC(MatCreateVecs(equations.jacobian(), x.put(), nullptr));
  EIGENGRAIN_PETSC(VecZeroEntries(x.get()));
  const PetscErrorCode code = SNESSolve(solver.get(), nullptr, x.get());
  NewtonResult result;
  result.linear_iterations = context.linear_iterations;
  result.linear_failures = std::move(context.linear_failures);
  result.linear_method = context.linear_method;
  result.course = std::move(context.course);
  if (options.interrupted && options.interrupted()) {  // the state is as it was
    result.ratio = context.first_ratio;
    result.interrupted = true;
    result.why = "interrupted";
    return result;
  }
  if (context.failure) std::rethrow_exception(context.failure);
  EIGENGRAIN_PETSC(code);

  result.ratio = context.ratio;
  SNESConvergedReason reason = SNES_CONVERGED_ITERATING;
  PetscInt iterations = 0;
  EIGENGRAIN_PETSC(SNESGetConvergedReason(solver.get(), &reason));
  EIGENGRAIN_PETSC(SNESGetIterationNumber(solver.get(), &iterations));
  result.iterations = static_cast<int>(iterations);
  result.converged = reason > 0;
  // What was gained is kept, and a new list goes on from there.
  result.unfinished = !result.converged && context.ratio < 0.5 * context.first_ratio;
  if (result.converged || result.unfinished) {
    Vector r;
    EIGENGRAIN_PETSC(VecDuplicate(x.get(), r.put()));
    equations.residual(x.get(), r.get());  // moved() is that of the solution
    // SNES may have ended on a step beyond the one that was judged.
    if (equations.ratio(r.get()) <= context.ratio)
      commit(state, equations.moved(), equations.moved_balls());
    else
      result.converged = result.unfinished = false;
  }
  if (!result.converged) {
    result.why = fmt::format("{}{}", SNESConvergedReasons[reason],
                             context.out_of_room ? ", after a step beyond the list of contacts" : "");
  }
  return result;
}

}  // namespace eigengrain::relaxation
