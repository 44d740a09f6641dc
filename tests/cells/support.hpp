#pragma once

#include "eigengrain/model/surroundings.hpp"

#include "support/motion.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

/// Periodic cells that deform, for tests.
namespace eigengrain::test {

/// Edges of 2 to 5 of which each leans by up to `slant` of its length towards each other axis, but no cell
/// that is nearly flat.
inline model::PeriodicCell slanted_cell(std::mt19937_64& random, double slant) {
  std::uniform_real_distribution<double> uniform(-1, 1);
  model::PeriodicCell cell;
  cell.periodic = {true, true, true};
  cell.origin = {uniform(random), uniform(random), uniform(random)};
  do {
    for (int k = 0; k < 3; ++k) {
      const double length = 3.5 + 1.5 * uniform(random);
      for (int i = 0; i < 3; ++i) cell.edges(i, k) = i == k ? length : slant * length * uniform(random);
    }
  } while (cell.volume() < 0.4 * cell.lengths().prod());
  return cell;
}

/// A velocity gradient of zeros but for one entry, 1/s.
inline Mat3 shear_rate(int along, int over, double rate) {
  Mat3 gradient = Mat3::Zero();
  gradient(along, over) = rate;
  return gradient;
}

/// The way from one point to the nearest image of another.
inline double apart_in(const model::PeriodicCell& cell, const Vec3& x, const Vec3& y) {
  const Vec3 cells = cell.inverse() * (y - x);
  Vec3 nearest = cells;
  for (int k = 0; k < 3; ++k)
    if (cell.periodic[static_cast<std::size_t>(k)]) nearest[k] -= std::round(cells[k]);
  return (cell.basis() * nearest).norm();
}

/// The greatest distance of bodies of one state from images of the same bodies in another.
inline double apart(const assembly::State& a, const assembly::State& b) {
  double most = 0;
  const std::vector<Vec3> x = positions_of(a);
  const std::vector<Vec3> y = positions_of(b);
  for (std::size_t i = 0; i < x.size(); ++i) most = std::max(most, apart_in(a.model.cell, x[i], y[i]));
  return most;
}

/// The cell of a state by edges that slant over one more cell.
inline void lean_over(model::PeriodicCell& cell, int along, int over) {
  cell.edges.col(over) += cell.edges.col(along);
  cell.rate.col(over) += cell.rate.col(along);
}

}  // namespace eigengrain::test
