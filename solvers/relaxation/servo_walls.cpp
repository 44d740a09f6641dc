#include "servo_walls.hpp"

#include "eigengrain/assembly/step_wall.hpp"
#include "eigengrain/base/error.hpp"

#include "equations.hpp"
#include "linear_solver.hpp"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace eigengrain::relaxation {
namespace {

using assembly::State;
using assembly::WallStep;
using petsc::Vector;

/// Way of a wall for differences, over the reach of the list: far above the rounding of places, far below
/// what opens contacts.
constexpr double probe = 1e-5;
/// Longest way of a wall at a time, and of a body, over the reach.
constexpr double longest_way = 0.1;
constexpr double room = 0.4;
constexpr double linear_tolerance = 1e-8;

std::vector<std::size_t> servos_of(const assembly::Model& model) {
  std::vector<std::size_t> servos;
  for (std::size_t m = 0; m < model.wall_motions.size(); ++m)
    if (model.wall_motions[m].servo) servos.push_back(m);
  return servos;
}

double missing(const model::WallMotion& motion, const std::vector<assembly::WallLoad>& loads) {
  return motion.servo->force +
         loads[static_cast<std::size_t>(motion.wall)].force.dot(motion.servo->direction);
}

/// Where walls are, to be put back there.
class WallPlaces {
 public:
  explicit WallPlaces(const assembly::Model& model)
      : planes_(model.walls), surfaces_(model.surface_places), poses_(model.wall_poses) {}
  void restore(assembly::Model& model) const {
    model.walls = planes_;
    model.surface_places = surfaces_;
    model.wall_poses = poses_;
  }

 private:
  std::vector<model::Plane> planes_;
  std::vector<contact::SurfacePlace> surfaces_;
  std::vector<model::WallPose> poses_;
};

/// Moves a wall by a way along the direction of its servo, and notes the step.
void move_wall(State& state, std::size_t m, double way, WallStep& step) {
  assembly::step_wall(state, m, {way * state.model.wall_motions[m].servo->direction, Vec3::Zero()}, step);
}

double dot(Vec x, Vec y) {
  PetscScalar product = 0;
  EIGENGRAIN_PETSC(VecDot(x, y, &product));
  return product;
}

/// What bodies have to do with the walls at a moment.
struct Response {
  std::vector<Vector> push;    ///< [servos] G: forces on bodies per way of the wall
  std::vector<Vector> follow;  ///< [servos] K⁻¹ G
  Eigen::MatrixXd stiffness;   ///< S
};

Response response_of(State& state, Equations& equations, Vec x, const std::vector<std::size_t>& servos,
                     double reach, LinearSolver& linear) {
  Vector rest;
  EIGENGRAIN_PETSC(VecDuplicate(x, rest.put()));
  equations.residual(x, rest.get());
  equations.assemble(rest.get());
  linear.matrix_changed();
  const auto count = static_cast<Eigen::Index>(servos.size());
  Response response{.push = std::vector<Vector>(servos.size()),
                    .follow = std::vector<Vector>(servos.size()),
                    .stiffness = Eigen::MatrixXd::Zero(count, count)};
  const double way = probe * reach;
  const Vec3 total = equations.total_force();
  for (std::size_t s = 0; s < servos.size(); ++s) {
    const WallPlaces before(state.model);
    const model::WallMotion& motion = state.model.wall_motions[servos[s]];
    WallStep step(state.model);
    move_wall(state, servos[s], way, step);
    equations.set_walls(&step);
    Vec g = nullptr;
    EIGENGRAIN_PETSC(VecDuplicate(x, response.push[s].put()));
    EIGENGRAIN_PETSC(VecDuplicate(x, response.follow[s].put()));
    g = response.push[s].get();
    equations.residual(x, g);
    equations.set_walls(nullptr);
    const auto i = static_cast<Eigen::Index>(s);
    response.stiffness(i, i) = (equations.total_force() - total).dot(motion.servo->direction) / way;
    before.restore(state.model);
    EIGENGRAIN_PETSC(VecAYPX(g, -1, rest.get()));  // a residual is minus a force
    EIGENGRAIN_PETSC(VecScale(g, 1 / way));
    const LinearOutcome outcome = linear.solve(g, response.follow[s].get(), linear_tolerance);
    if (!outcome.solved)
      throw SolverError("no linear solver found how bodies follow a servo wall: " + outcome.failures.back());
  }
  for (Eigen::Index i = 0; i < count; ++i)
    for (Eigen::Index j = 0; j < count; ++j)
      response.stiffness(i, j) -= dot(response.push[static_cast<std::size_t>(i)].get(),
                                      response.follow[static_cast<std::size_t>(j)].get());
  return response;
}

}  // namespace

bool has_servo_walls(const assembly::Model& model) {
  return !servos_of(model).empty();
}

double missing_force(const assembly::Model& model) {
  const std::vector<std::size_t> servos = servos_of(model);
  if (servos.empty()) return 0;
  const std::vector<assembly::WallLoad> loads = assembly::wall_loads(model);
  double most = 0;
  for (const std::size_t m : servos) {
    const model::WallMotion& motion = model.wall_motions[m];
    most = std::max(most, std::abs(missing(motion, loads)) / motion.servo->force);
  }
  return most;
}

void drive_servo_walls(State& state, double reach, const std::function<bool()>& interrupted) {
  const std::vector<std::size_t> servos = servos_of(state.model);
  Equations equations(state, reach);
  LinearSolver linear(equations.jacobian(), {.contrast = equations.contrast(),
                                             .rigid_motions = [&] { return equations.rigid_motions(); },
                                             .interrupted = interrupted});
  Vector x;
  EIGENGRAIN_PETSC(MatCreateVecs(equations.jacobian(), x.put(), nullptr));
  EIGENGRAIN_PETSC(VecZeroEntries(x.get()));
  const Response response = response_of(state, equations, x.get(), servos, reach, linear);
  const std::vector<assembly::WallLoad> loads = assembly::wall_loads(state.model);
  Eigen::VectorXd wanted(static_cast<Eigen::Index>(servos.size()));
  for (std::size_t s = 0; s < servos.size(); ++s)
    wanted[static_cast<Eigen::Index>(s)] = missing(state.model.wall_motions[servos[s]], loads);
  // A wall that touches nothing has no row: it stays, and the explicit cycle brings it back.
  Eigen::VectorXd way = response.stiffness.fullPivLu().solve(wanted);
  if (!way.allFinite()) return;
  const double far = way.cwiseAbs().maxCoeff();
  if (far > longest_way * reach) way *= longest_way * reach / far;
  for (std::size_t s = 0; s < servos.size(); ++s)
    EIGENGRAIN_PETSC(VecAXPY(x.get(), way[static_cast<Eigen::Index>(s)], response.follow[s].get()));
  PetscReal farthest = 0;
  EIGENGRAIN_PETSC(VecNorm(x.get(), NORM_INFINITY, &farthest));
  if (farthest > room * reach) {
    EIGENGRAIN_PETSC(VecScale(x.get(), room * reach / farthest));
    way *= room * reach / farthest;
  }
  Vector r;
  EIGENGRAIN_PETSC(VecDuplicate(x.get(), r.put()));
  equations.residual(x.get(), r.get());  // moved() is that of x
  WallStep step(state.model);
  for (std::size_t s = 0; s < servos.size(); ++s)
    move_wall(state, servos[s], way[static_cast<Eigen::Index>(s)], step);
  commit(state, equations.moved(), equations.moved_balls(), &step);
}

}  // namespace eigengrain::relaxation
