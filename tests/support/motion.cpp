#include "support/motion.hpp"

#include <Eigen/Eigenvalues>

namespace eigengrain::test {

cycle::TimestepPolicy fixed_step(double dt) {
  return {[dt](const assembly::State&) { return dt; }, 0};
}

cycle::Cycle cycle_of(SceneBuilder builder, double dt) {
  return cycle::Cycle(cycle::start(builder.scene()), fixed_step(dt));
}

MeanMotion mean_motion(cycle::Cycle& cycle, int steps) {
  MeanMotion mean;
  for (int k = 0; k < steps; ++k) {
    cycle.step();
    mean.speed += velocity_of(cycle.state(), 0).x() / steps;
    mean.surface += (velocity_of(cycle.state(), 0).x() - spin_of(cycle.state(), 0).y()) / steps;
  }
  return mean;
}

std::vector<Vec3> positions_of(const assembly::State& state) {
  const model::Bodies& bodies = state.model.bodies;
  std::vector<Vec3> result(bodies.position.size());
  for (std::size_t i = 0; i < result.size(); ++i)
    result[static_cast<std::size_t>(bodies.identity[i])] = bodies.position[i];
  return result;
}

std::vector<Vec3> shears_of(const assembly::State& state) {
  std::vector<Vec3> result;
  for_each_shear(state.model, [&](const auto&, const auto& s) { result.push_back(s.shear); });
  return result;
}

Modes::Modes(const System& system) : system_(system), free_(system.unknowns.free_components()) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(assembly::dense_scaled_stiffness(system));
  lambda_ = solver.eigenvalues();
  shape_ = solver.eigenvectors();  // of M^-½ K M^-½
  for (Eigen::Index r = 0; r < shape_.rows(); ++r) shape_.row(r) /= std::sqrt(mass(r));
}

}  // namespace eigengrain::test
