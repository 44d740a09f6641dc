#include "newton.hpp"

#include "eigengrain/assembly/balance.hpp"
#include "eigengrain/assembly/clump_members.hpp"
#include "eigengrain/assembly/forces.hpp"
#include "eigengrain/assembly/linear_system.hpp"
#include "eigengrain/assembly/loads.hpp"
#include "eigengrain/assembly/tangent.hpp"
#include "eigengrain/petsc/session.hpp"

#include "petsc/handles.hpp"
#include "petsc/stiffness_matrix.hpp"

#include <fmt/format.h>
#include <petscsnes.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <utility>
#include <vector>

namespace eigengrain::relaxation {
namespace {

using assembly::Displacement;
using assembly::State;
using petsc::Vector;
using Solver = petsc::Owner<SNES, SNESDestroy>;

/// Longest step of a body that nothing holds, in one iteration, over the reach of the list: at first, and
/// ever.
constexpr double first_step = 0.004;
constexpr double greatest_step = 0.02;
constexpr double growth = 2;
constexpr double retreat = 4;
/// A residual that has grown by more than this asks for a shorter step.
constexpr double grown = 1.5;

/// The equations: residual and Jacobian in the unknowns (u, R θ), all lengths, with residuals (force,
/// moment/R), all forces, so that one norm means something for both.
class Equations {
 public:
  Equations(const State& state, const NewtonOptions& options)
      : state_(state),
        system_(state.model, assembly::Listed::all),
        forces_(state.model, state.turns()),
        matrix_(system_.unknowns, system_.elements),
        balance_(assembly::balance_of(state)),
        reach_(options.reach),
        longest_step_(first_step * options.reach) {
    const auto bodies = static_cast<std::size_t>(state.model.bodies.size());
    moved_.translation.assign(bodies, Vec3::Zero());
    if (state.turns()) moved_.rotation.assign(bodies, Vec3::Zero());
    position_.resize(bodies);
    EIGENGRAIN_PETSC(MatCreateVecs(matrix_.mat(), scale_.put(), mass_.put()));
    fill_scale();
  }

  PetscInt size() const { return static_cast<PetscInt>(system_.unknowns.size()); }
  Mat jacobian() const { return matrix_.mat(); }
  const Displacement& moved() const { return moved_; }
  /// The same of all balls, which those of clumps share.
  const Displacement& moved_balls() const { return clumps().empty() ? moved_ : carried_; }

  /// r(x) = -(contacts + gravity + applied loads) on the free components.
  void residual(Vec x, Vec r) {
    place(x);
    forces_.evaluate(state_.model, trial(), sum_);
    gather_forces();
    const PetscScalar* scale = nullptr;
    PetscScalar* out = nullptr;
    EIGENGRAIN_PETSC(VecGetArrayRead(scale_.get(), &scale));
    EIGENGRAIN_PETSC(VecGetArrayWrite(r, &out));
    for_each_number([&](std::size_t number, std::int32_t body, int k, bool turns, bool fixed) {
      const auto i = static_cast<std::size_t>(body);
      const double force = turns ? sum_.moment[i][k] : sum_.force[i][k];
      out[number] = fixed ? 0.0 : -force * scale[number];
    });
    EIGENGRAIN_PETSC(VecRestoreArrayRead(scale_.get(), &scale));
    EIGENGRAIN_PETSC(VecRestoreArrayWrite(r, &out));
  }

  /// A longer step after a residual that has fallen, a shorter one after one that has grown.
  void adapt_step(double ratio_before, double ratio_now) {
    if (ratio_now <= ratio_before)
      longest_step_ = std::min(growth * longest_step_, greatest_step * reach_);
    else if (ratio_now > grown * ratio_before)
      longest_step_ /= retreat;
  }

  /// The consistent tangent where residual() was last asked, and the shift for the residual r there.
  void assemble(Vec r) {
    matrix_.begin();
    assembly::assemble_tangent(state_.model, trial(), matrix_);
    matrix_.end();
    EIGENGRAIN_PETSC(MatDiagonalScale(matrix_.mat(), scale_.get(), scale_.get()));
    Vector shift;
    EIGENGRAIN_PETSC(VecDuplicate(mass_.get(), shift.put()));
    EIGENGRAIN_PETSC(VecCopy(mass_.get(), shift.get()));
    EIGENGRAIN_PETSC(VecScale(shift.get(), shift_for(r)));
    EIGENGRAIN_PETSC(MatDiagonalSet(matrix_.mat(), shift.get(), ADD_VALUES));
  }

  /// Mean unbalanced ratio of a residual, the larger of forces and moments, over the mean contact force of
  /// the committed state.
  double ratio(Vec r) const {
    const PetscScalar* values = nullptr;
    EIGENGRAIN_PETSC(VecGetArrayRead(r, &values));
    double forces = 0;
    double moments = 0;
    for (std::int32_t block = 0; block < system_.unknowns.blocks(); ++block)
      (system_.unknowns.is_rotation(block) ? moments : forces) +=
          Eigen::Map<const Vec3>(&values[3 * block]).norm();
    EIGENGRAIN_PETSC(VecRestoreArrayRead(r, &values));
    return std::max(forces, moments) / (static_cast<double>(balance_.bodies) * balance_.mean_contact_force);
  }

  /// Shortens the step of each body that would leave what the list of contacts knows; whether any had to.
  /// Body by body: one that floats or rolls must not hold up the others.
  bool limit(Vec x, Vec y) const {
    const double whole_room = 0.45 * reach_;
    const PetscScalar* at = nullptr;
    PetscScalar* step = nullptr;
    bool limited = false;
    EIGENGRAIN_PETSC(VecGetArrayRead(x, &at));
    EIGENGRAIN_PETSC(VecGetArray(y, &step));
    for (std::int32_t block = 0; block < system_.unknowns.blocks(); ++block) {
      // A ball of a clump may go both ways of it.
      const double room =
          clumps().of(system_.unknowns.body(block)) == model::Clumps::none ? whole_room : 0.5 * whole_room;
      const Eigen::Map<const Vec3> from(&at[3 * block]);
      Eigen::Map<Vec3> by(&step[3 * block]);
      const Vec3 to = from - by;  // SNES subtracts
      const double way = to.norm();
      if (way <= room) continue;
      by = from - (room / way) * to;
      limited = true;
    }
    EIGENGRAIN_PETSC(VecRestoreArrayRead(x, &at));
    EIGENGRAIN_PETSC(VecRestoreArray(y, &step));
    return limited;
  }

 private:
  const model::Clumps& clumps() const { return state_.model.bodies.clumps; }

  /// Forces of contacts on balls to those on bodies with all loads; moments of clumps along their axes.
  void gather_forces() {
    if (!clumps().empty()) assembly::gather_members(state_.model.bodies, carried_.rotation, sum_);
    for (std::size_t i = 0; i < sum_.force.size(); ++i) sum_.force[i] += assembly::load_on(state_.model, i);
    if (!state_.model.bodies.applied_moment.empty())
      for (std::size_t i = 0; i < sum_.moment.size(); ++i)
        sum_.moment[i] += assembly::moment_on(state_.model, i);
    for (std::int32_t c = 0; c < clumps().size(); ++c) {
      Vec3& moment = sum_.moment[static_cast<std::size_t>(clumps().holder(c))];
      moment = (clumps().orientation[static_cast<std::size_t>(c)].conjugate() * moment).eval();
    }
  }
  /// What the unknowns of clumps, along their axes, mean for their balls.
  void carry_clumps() {
    if (clumps().empty()) return;
    for (std::int32_t c = 0; c < clumps().size(); ++c) {
      Vec3& theta = moved_.rotation[static_cast<std::size_t>(clumps().holder(c))];
      theta = (clumps().orientation[static_cast<std::size_t>(c)] * theta).eval();
    }
    carried_ = moved_;
    assembly::carry_members(state_.model.bodies, carried_);
  }
  /// Of a body, where θ has moved its surface by as much as u = R θ, m.
  double size_of(std::int32_t body) const {
    const std::int32_t clump = clumps().of(body);
    return clump == model::Clumps::none ? state_.model.bodies.radius[static_cast<std::size_t>(body)]
                                        : clumps().radius[static_cast<std::size_t>(clump)];
  }

  /// σ: with it alone, the body that is accelerated most would step by longest_step.
  double shift_for(Vec r) const {
    const PetscScalar* force = nullptr;
    const PetscScalar* mass = nullptr;
    double fastest = 0;
    EIGENGRAIN_PETSC(VecGetArrayRead(r, &force));
    EIGENGRAIN_PETSC(VecGetArrayRead(mass_.get(), &mass));
    for (std::int32_t block = 0; block < system_.unknowns.blocks(); ++block)
      fastest = std::max(fastest, Eigen::Map<const Vec3>(&force[3 * block]).norm() / mass[3 * block]);
    EIGENGRAIN_PETSC(VecRestoreArrayRead(mass_.get(), &mass));
    EIGENGRAIN_PETSC(VecRestoreArrayRead(r, &force));
    return fastest / longest_step_;
  }

  template <class Visit>
  void for_each_number(const Visit& visit) const {
    const assembly::Unknowns& unknowns = system_.unknowns;
    for (std::int32_t block = 0; block < unknowns.blocks(); ++block)
      for (int k = 0; k < 3; ++k)
        visit(std::size_t{3} * block + k, unknowns.body(block), k, unknowns.is_rotation(block),
              unknowns.is_fixed(block, k));
  }

  void fill_scale() {
    PetscScalar* scale = nullptr;
    PetscScalar* mass = nullptr;
    EIGENGRAIN_PETSC(VecGetArrayWrite(scale_.get(), &scale));
    EIGENGRAIN_PETSC(VecGetArrayWrite(mass_.get(), &mass));
    for_each_number([&](std::size_t number, std::int32_t body, int, bool turns, bool) {
      scale[number] = turns ? 1.0 / size_of(body) : 1.0;
      mass[number] = system_.mass[number] * scale[number] * scale[number];
    });
    EIGENGRAIN_PETSC(VecRestoreArrayWrite(scale_.get(), &scale));
    EIGENGRAIN_PETSC(VecRestoreArrayWrite(mass_.get(), &mass));
  }

  void place(Vec x) {
    const PetscScalar* values = nullptr;
    const PetscScalar* scale = nullptr;
    EIGENGRAIN_PETSC(VecGetArrayRead(x, &values));
    EIGENGRAIN_PETSC(VecGetArrayRead(scale_.get(), &scale));
    for_each_number([&](std::size_t number, std::int32_t body, int k, bool turns, bool) {
      (turns ? moved_.rotation : moved_.translation)[body][k] = values[number] * scale[number];
    });
    EIGENGRAIN_PETSC(VecRestoreArrayRead(scale_.get(), &scale));
    EIGENGRAIN_PETSC(VecRestoreArrayRead(x, &values));
    carry_clumps();
    const Displacement& balls = moved_balls();
    for (std::size_t i = 0; i < position_.size(); ++i)
      position_[i] = state_.model.bodies.position[i] + balls.translation[i];
    orientation_ = assembly::turned_orientations(state_.model.bodies, balls.rotation);
  }
  assembly::Trial trial() const {
    return {position_, moved_balls().translation, moved_balls().rotation, 1.0, orientation_};
  }

  const State& state_;
  assembly::LinearSystem system_;
  assembly::ContactForceSum forces_;
  petsc::StiffnessMatrix matrix_;
  assembly::Balance balance_;
  double reach_;         ///< of the list of contacts, m
  double longest_step_;  ///< of a body that nothing holds, m
  Vector scale_;
  Vector mass_;           ///< of the unknowns: m and I/R²
  Displacement moved_;    ///< of bodies: of a clump in the row of its holder
  Displacement carried_;  ///< of all balls, where there are clumps
  std::vector<Vec3> position_;
  std::vector<Quat> orientation_;
  assembly::BodyForces sum_;
};

/// What SNES calls back. An exception must not cross C: it is kept and thrown again outside.
struct Context {
  Equations& equations;
  const NewtonOptions& options;
  double first_ratio = 0;
  double ratio = 0;
  bool out_of_room = false;
  std::exception_ptr failure{};

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
  return c.guarded([&] { c.equations.residual(x, r); });
}

PetscErrorCode form_jacobian(SNES solver, Vec /*x*/, Mat /*jacobian*/, Mat /*preconditioner*/,
                             void* context) {
  auto& c = *static_cast<Context*>(context);
  return c.guarded([&] {
    Vec r = nullptr;
    EIGENGRAIN_PETSC(SNESGetFunction(solver, &r, nullptr, nullptr));
    c.equations.assemble(r);
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
    const double before = c.ratio;
    c.ratio = c.equations.ratio(r);
    if (iteration == 0)
      c.first_ratio = c.ratio;
    else
      c.equations.adapt_step(before, c.ratio);
    *reason = SNES_CONVERGED_ITERATING;
    if (c.ratio <= c.options.target)
      *reason = SNES_CONVERGED_FNORM_ABS;
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
  EIGENGRAIN_PETSC(KSPSetType(linear, KSPBCGS));
  EIGENGRAIN_PETSC(KSPSetTolerances(linear, 1e-5, 0, PETSC_DEFAULT, 2000));
  EIGENGRAIN_PETSC(KSPGetPC(linear, &preconditioner));
  EIGENGRAIN_PETSC(PCSetType(preconditioner, PCILU));
  EIGENGRAIN_PETSC(PCFactorSetShiftType(preconditioner, MAT_SHIFT_NONZERO));
  EIGENGRAIN_PETSC(SNESSetFromOptions(solver.get()));
  return solver;
}

/// The displacement of bodies, and of all balls, becomes a part of the state.
void commit(State& state, const Displacement& of_bodies, const Displacement& moved) {
  model::Bodies& bodies = state.model.bodies;
  for (std::size_t i = 0; i < bodies.position.size(); ++i) bodies.position[i] += moved.translation[i];
  assembly::commit_clumps(bodies, of_bodies);
  bodies.orientation = assembly::turned_orientations(bodies, moved.rotation);
  assembly::BodyForces sum;
  assembly::ContactForceSum contacts(state.model, state.turns());
  contacts.advance(state.model, {bodies.position, moved.translation, moved.rotation, 1.0, bodies.orientation},
                   sum);
  assembly::note_breaks(state, contacts.broken());
  state.force = std::move(sum.force);
  state.moment = std::move(sum.moment);
}

}  // namespace

NewtonResult newton(State& state, const NewtonOptions& options) {
  petsc::start();
  Equations equations(state, options);
  Context context{equations, options};
  const Solver solver = new_solver(context);
  Vector x;
  EIGENGRAIN_PETSC(MatCreateVecs(equations.jacobian(), x.put(), nullptr));
  EIGENGRAIN_PETSC(VecZeroEntries(x.get()));
  const PetscErrorCode code = SNESSolve(solver.get(), nullptr, x.get());
  if (context.failure) std::rethrow_exception(context.failure);
  EIGENGRAIN_PETSC(code);

  NewtonResult result;
  result.ratio = context.ratio;
  SNESConvergedReason reason = SNES_CONVERGED_ITERATING;
  PetscInt iterations = 0;
  PetscInt linear_iterations = 0;
  EIGENGRAIN_PETSC(SNESGetConvergedReason(solver.get(), &reason));
  EIGENGRAIN_PETSC(SNESGetIterationNumber(solver.get(), &iterations));
  EIGENGRAIN_PETSC(SNESGetLinearSolveIterations(solver.get(), &linear_iterations));
  result.iterations = static_cast<int>(iterations);
  result.linear_iterations = static_cast<int>(linear_iterations);
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
