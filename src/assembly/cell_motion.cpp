#include "eigengrain/assembly/cell_motion.hpp"

#include "eigengrain/assembly/state.hpp"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>

namespace eigengrain::assembly {
namespace {

/// How far bodies may go beyond the flow while the list holds, m. A pair that is not listed was more than
/// r_a + r_b + skin apart; the flow leaves it at least the part σ of that, σ the least stretch since.
double margin_of(const Mat3& carry, double skin, double largest_radius) {
  const Mat3 squared = carry.transpose() * carry;
  const double least =
      std::sqrt(Eigen::SelfAdjointEigenSolver<Mat3>(squared, Eigen::EigenvaluesOnly).eigenvalues()[0]);
  const double nearer = std::max(0.0, 1 - least) * 2 * largest_radius;
  return 0.5 * std::min(skin, least * skin - nearer);
}

}  // namespace

CellStep move_cell(State& state, double dt) {
  model::PeriodicCell& cell = state.model.cell;
  model::PeriodicCell listed = cell;
  listed.edges = state.list.edges;
  const Mat3 inverse = cell.inverse();
  const Mat3 rate = mean_gradient(cell.velocity_gradient, dt) * cell.edges;
  CellStep step{.origin = cell.origin,
                .behind = cell.rate * inverse,
                .gain = (rate - cell.rate) * inverse,
                .carry = Mat3::Identity(),
                .margin = 0};
  cell.rate = rate;
  cell.edges += dt * rate;
  step.carry = cell.basis() * listed.inverse();
  const std::vector<double>& radius = state.model.bodies.radius;
  step.margin = margin_of(step.carry, state.list.skin, *std::max_element(radius.begin(), radius.end()));
  return step;
}

Mat3 mean_gradient(const Mat3& velocity_gradient, double dt) {
  // φ(X) = (exp(X) - 1)/X, with φ(2X) = φ(X) + ½ X φ(X)².
  constexpr double longest = 0.5;
  constexpr int terms = 16;  // 0.5^16/17! is below 1e-19
  Mat3 x = dt * velocity_gradient;
  int halvings = 0;
  for (; x.norm() > longest; x *= 0.5) ++halvings;
  Mat3 phi = Mat3::Identity();
  for (int k = terms; k >= 1; --k) phi = Mat3::Identity() + x * phi / (k + 1);
  for (; halvings > 0; --halvings, x *= 2) phi += (0.5 * x * phi * phi).eval();
  return velocity_gradient * phi;
}

}  // namespace eigengrain::assembly
