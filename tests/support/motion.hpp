#pragma once

#include "eigengrain/assembly/state.hpp"
#include "eigengrain/cycle/cycle.hpp"

#include "support/scenes.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <variant>
#include <vector>

/// Scenes of a few bodies in motion, for tests of the cycle.
namespace eigengrain::test {

cycle::TimestepPolicy fixed_step(double dt);

/// A scene at its start, with a fixed step.
cycle::Cycle cycle_of(SceneBuilder builder, double dt);

/// Row of a body by its place in the scene: bodies are stored in an order of their own.
inline std::size_t row_of(const assembly::State& state, std::int64_t identity) {
  const auto& all = state.model.bodies.identity;
  return static_cast<std::size_t>(std::find(all.begin(), all.end(), identity) - all.begin());
}
inline const Vec3& position_of(const assembly::State& state, std::int64_t identity) {
  return state.model.bodies.position[row_of(state, identity)];
}
inline const Vec3& velocity_of(const assembly::State& state, std::int64_t identity) {
  return state.model.bodies.velocity[row_of(state, identity)];
}
inline const Vec3& spin_of(const assembly::State& state, std::int64_t identity) {
  return state.model.bodies.spin[row_of(state, identity)];
}

/// Means over some steps of ball 0 of a cycle.
struct MeanMotion {
  double speed = 0;    ///< along x
  double surface = 0;  ///< along x, of its lowest point; for a radius of one
};
MeanMotion mean_motion(cycle::Cycle& cycle, int steps);

/// Positions in the order of the scene.
std::vector<Vec3> positions_of(const assembly::State& state);

/// Calls visitor(pair, state) for every listed contact whose law has a shear force.
template <class Visitor>
void for_each_shear(const assembly::Model& model, const Visitor& visitor) {
  model.contacts.for_each_group([&](const auto& group) {
    if constexpr (requires { group.states.front().shear; })
      for (std::size_t c = 0; c < group.pairs.size(); ++c) visitor(group.pairs[c], group.states[c]);
  });
}

/// Shear forces of all listed contacts, in their order.
std::vector<Vec3> shears_of(const assembly::State& state);

/// The modes of a system, M-orthonormal, and the way between modes and motions of bodies.
class Modes {
 public:
  explicit Modes(const System& system);

  const Eigen::VectorXd& lambda() const { return lambda_; }
  double lambda_max() const { return lambda_[lambda_.size() - 1]; }
  Eigen::Index critical() const { return lambda_.size() - 1; }

  /// Gives a scene, of which the system was built, the velocities factor · mode, added to what is there.
  void add_velocity(model::Scene& scene, Eigen::Index mode, double factor) const {
    model::Bodies& bodies = scene.bodies;
    bodies.velocity.resize(bodies.position.size(), Vec3::Zero());
    bodies.spin.resize(bodies.position.size(), Vec3::Zero());
    for (Eigen::Index r = 0; r < shape_.rows(); ++r) {
      const auto [block, k, body] = place(r);
      const auto identity = static_cast<std::size_t>(system_.model.bodies.identity[body]);
      (system_.unknowns.is_rotation(block) ? bodies.spin : bodies.velocity)[identity][k] +=
          factor * shape_(r, mode);
    }
  }
  /// How much of a mode the velocities of a state hold: φ·M v. The state is of the same scene.
  double part(const assembly::State& state, Eigen::Index mode) const {
    double sum = 0;
    for (Eigen::Index r = 0; r < shape_.rows(); ++r) {
      const auto [block, k, body] = place(r);
      const model::Bodies& bodies = state.model.bodies;
      sum += shape_(r, mode) * mass(r) *
             (system_.unknowns.is_rotation(block) ? bodies.spin : bodies.velocity)[body][k];
    }
    return sum;
  }
  /// The largest velocity of a body's surface in a mode, to turn a mode into a distance.
  double largest(Eigen::Index mode) const {
    double most = 0;
    for (Eigen::Index r = 0; r < shape_.rows(); ++r) {
      const auto [block, k, body] = place(r);
      const double arm = system_.unknowns.is_rotation(block) ? system_.model.bodies.radius[body] : 1;
      most = std::max(most, std::abs(arm * shape_(r, mode)));
    }
    return most;
  }

 private:
  struct Place {
    std::int32_t block;
    int k;
    std::size_t body;
  };
  Place place(Eigen::Index row) const {
    const std::int32_t number = free_[static_cast<std::size_t>(row)];
    const std::int32_t block = number / assembly::Unknowns::block_size;
    return {block, number % assembly::Unknowns::block_size,
            static_cast<std::size_t>(system_.unknowns.body(block))};
  }
  double mass(Eigen::Index row) const {
    return system_.mass[static_cast<std::size_t>(free_[static_cast<std::size_t>(row)])];
  }

  const System& system_;
  std::vector<std::int32_t> free_;
  Eigen::VectorXd lambda_;
  Eigen::MatrixXd shape_;
};

}  // namespace eigengrain::test
