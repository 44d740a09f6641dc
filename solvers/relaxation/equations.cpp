#include "equations.hpp"

#include "eigengrain/assembly/body_size.hpp"
#include "eigengrain/assembly/clump_members.hpp"
#include "eigengrain/assembly/loads.hpp"
#include "eigengrain/assembly/tangent.hpp"
#include "eigengrain/petsc/session.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace eigengrain::relaxation {
namespace {

using assembly::Displacement;
using assembly::State;
using petsc::Vector;

/// Longest step of a body that nothing holds, in one iteration, over the reach of the list: at first, and
/// ever.
constexpr double first_step = 0.004;
constexpr double greatest_step = 0.02;
constexpr double growth = 2;
constexpr double retreat = 4;
/// A residual that has grown by more than this asks for a shorter step.
constexpr double grown = 1.5;

}  // namespace

Equations::Equations(const State& state, double reach)
    : state_(state),
      system_(state.model, assembly::Listed::all),
      forces_(state.model, state.turns()),
      matrix_(system_.unknowns, system_.parts()),
      balance_(assembly::balance_of(state)),
      reach_(reach),
      longest_step_(first_step * reach) {
  const auto bodies = static_cast<std::size_t>(state.model.bodies.size());
  moved_.translation.assign(bodies, Vec3::Zero());
  if (state.turns()) moved_.rotation.assign(bodies, Vec3::Zero());
  position_.resize(bodies);
  EIGENGRAIN_PETSC(MatCreateVecs(matrix_.mat(), scale_.put(), mass_.put()));
  fill_scale();
}

void Equations::residual(Vec x, Vec r) {
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

Vec3 Equations::total_force() const {
  const model::Bodies& bodies = state_.model.bodies;
  Vec3 total = Vec3::Zero();
  for (std::int32_t row = 0; row < bodies.size(); ++row)
    if (bodies.clumps.owner(row) == row) total += sum_.force[static_cast<std::size_t>(row)];
  return total;
}

void Equations::adapt_step(double ratio_before, double ratio_now) {
  if (ratio_now <= ratio_before)
    longest_step_ = std::min(growth * longest_step_, greatest_step * reach_);
  else if (ratio_now > grown * ratio_before)
    longest_step_ /= retreat;
}

void Equations::assemble(Vec r) {
  matrix_.begin();
  assembly::assemble_tangent(state_.model, trial(), matrix_);
  assembly::for_each_nodal_tangent(state_.model, trial(), system_.unknowns,
                                   [&](std::int32_t row, std::int32_t column, const Mat3& block) {
                                     matrix_.add_block(row, column, block);
                                   });
  matrix_.end();
  EIGENGRAIN_PETSC(MatDiagonalScale(matrix_.mat(), scale_.get(), scale_.get()));
  Vector shift;
  EIGENGRAIN_PETSC(VecDuplicate(mass_.get(), shift.put()));
  EIGENGRAIN_PETSC(VecCopy(mass_.get(), shift.get()));
  EIGENGRAIN_PETSC(VecScale(shift.get(), shift_for(r)));
  EIGENGRAIN_PETSC(MatDiagonalSet(matrix_.mat(), shift.get(), ADD_VALUES));
}

double Equations::contrast() const {
  double least = std::numeric_limits<double>::infinity();
  double most = 0;
  for (const contact::ContactElement& element : system_.elements) {
    if (!(element.stiffness.normal > 0)) continue;
    least = std::min(least, element.stiffness.normal);
    most = std::max(most, element.stiffness.normal);
  }
  return most > 0 ? most / least : 1;
}

std::vector<Vector> Equations::rigid_motions() const {
  std::vector<Vector> motions(6);
  const assembly::Unknowns& unknowns = system_.unknowns;
  const double* scale = nullptr;
  EIGENGRAIN_PETSC(VecGetArrayRead(scale_.get(), &scale));
  for (int k = 0; k < 6; ++k) {
    EIGENGRAIN_PETSC(VecDuplicate(scale_.get(), motions[k].put()));
    const Vec3 axis = Vec3::Unit(k % 3);
    double* values = nullptr;
    EIGENGRAIN_PETSC(VecGetArrayWrite(motions[k].get(), &values));
    for (std::int32_t block = 0; block < unknowns.blocks(); ++block) {
      const std::int32_t body = unknowns.body(block);
      Vec3 motion = Vec3::Zero();
      if (k < 3) {
        if (!unknowns.is_rotation(block)) motion = axis;
      } else if (!unknowns.is_rotation(block)) {
        motion = axis.cross(model::centre_of(state_.model.bodies, body));
      } else {
        motion = axis;
        if (const Mat3* axes = unknowns.axes(body)) motion = axes->transpose() * axis;
      }
      for (int i = 0; i < 3; ++i) {
        const std::size_t number = std::size_t{3} * block + i;
        values[number] = unknowns.is_fixed(block, i) ? 0 : motion[i] / scale[number];
      }
    }
    EIGENGRAIN_PETSC(VecRestoreArrayWrite(motions[k].get(), &values));
  }
  EIGENGRAIN_PETSC(VecRestoreArrayRead(scale_.get(), &scale));
  return motions;
}

double Equations::ratio(Vec r) const {
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

bool Equations::limit(Vec x, Vec y) const {
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

void Equations::gather_forces() {
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

void Equations::carry_clumps() {
  if (clumps().empty()) return;
  for (std::int32_t c = 0; c < clumps().size(); ++c) {
    Vec3& theta = moved_.rotation[static_cast<std::size_t>(clumps().holder(c))];
    theta = (clumps().orientation[static_cast<std::size_t>(c)] * theta).eval();
  }
  carried_ = moved_;
  assembly::carry_members(state_.model.bodies, carried_);
}

double Equations::shift_for(Vec r) const {
  const PetscScalar* force = nullptr;
  const PetscScalar* mass = nullptr;
  double fastest = 0;
  EIGENGRAIN_PETSC(VecGetArrayRead(r, &force));
  EIGENGRAIN_PETSC(VecGetArrayRead(mass_.get(), &mass));
  for (std::int32_t block = 0; block < system_.unknowns.blocks(); ++block) {
    const double least = Eigen::Map<const Vec3>(&mass[3 * block]).minCoeff();  // of three inertias
    fastest = std::max(fastest, Eigen::Map<const Vec3>(&force[3 * block]).norm() / least);
  }
  EIGENGRAIN_PETSC(VecRestoreArrayRead(mass_.get(), &mass));
  EIGENGRAIN_PETSC(VecRestoreArrayRead(r, &force));
  return fastest / longest_step_;
}

void Equations::fill_scale() {
  PetscScalar* scale = nullptr;
  PetscScalar* mass = nullptr;
  EIGENGRAIN_PETSC(VecGetArrayWrite(scale_.get(), &scale));
  EIGENGRAIN_PETSC(VecGetArrayWrite(mass_.get(), &mass));
  for_each_number([&](std::size_t number, std::int32_t body, int, bool turns, bool) {
    scale[number] = turns ? 1.0 / assembly::size_of(state_.model.bodies, body) : 1.0;
    mass[number] = system_.mass[number] * scale[number] * scale[number];
  });
  EIGENGRAIN_PETSC(VecRestoreArrayWrite(scale_.get(), &scale));
  EIGENGRAIN_PETSC(VecRestoreArrayWrite(mass_.get(), &mass));
}

void Equations::place(Vec x) {
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

void commit(State& state, const Displacement& of_bodies, const Displacement& of_balls,
            const assembly::WallStep* walls) {
  model::Bodies& bodies = state.model.bodies;
  for (std::size_t i = 0; i < bodies.position.size(); ++i) bodies.position[i] += of_balls.translation[i];
  assembly::commit_clumps(bodies, of_bodies);
  bodies.orientation = assembly::turned_orientations(bodies, of_balls.rotation);
  assembly::BodyForces sum;
  assembly::ContactForceSum contacts(state.model, state.turns());
  contacts.advance(
      state.model,
      {bodies.position, of_balls.translation, of_balls.rotation, 1.0, bodies.orientation, 0.0, walls}, sum);
  assembly::note_breaks(state, contacts.broken());
  state.force = std::move(sum.force);
  state.moment = std::move(sum.moment);
}

}  // namespace eigengrain::relaxation
