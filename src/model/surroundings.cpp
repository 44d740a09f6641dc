#include "eigengrain/model/surroundings.hpp"

#include <Eigen/LU>

#include <cmath>

namespace eigengrain::model {
namespace {

/// Part of an edge along another beyond which it is shortened. More than half by so much that rounding cannot
/// bring the longer one back.
constexpr double most_slanted = 0.5 + 0x1p-20;

}  // namespace

bool PeriodicCell::orthogonal() const {
  for (int k = 0; k < 3; ++k)
    for (int i = 0; i < 3; ++i)
      if (periodic[static_cast<std::size_t>(k)] && i != k && edges(i, k) != 0) return false;
  return true;
}

Mat3 PeriodicCell::basis() const {
  Mat3 result = edges;
  for (int k = 0; k < 3; ++k)
    if (!periodic[static_cast<std::size_t>(k)]) result.col(k) = Vec3::Unit(k);
  return result;
}

double PeriodicCell::volume() const {
  return std::abs(edges.determinant());
}

Mat3 PeriodicCell::inverse() const {
  return basis().inverse();
}

Mat3 PeriodicCell::flow_gradient() const {
  if (rate.isZero(0)) return Mat3::Zero();
  return rate * inverse();
}

Vec3 PeriodicCell::cell_of(const Vec3& x) const {
  Vec3 cells = Vec3::Zero();
  if (orthogonal()) {
    for (int k = 0; k < 3; ++k)
      if (periodic[static_cast<std::size_t>(k)]) cells[k] = std::floor((x[k] - origin[k]) / edges(k, k));
    return cells;
  }
  const Vec3 place = inverse() * (x - origin);
  for (int k = 0; k < 3; ++k)
    if (periodic[static_cast<std::size_t>(k)]) cells[k] = std::floor(place[k]);
  return cells;
}

Vec3 PeriodicCell::wrapped(const Vec3& x) const {
  Vec3 result = x;
  const Vec3 cells = cell_of(x);
  for (int k = 0; k < 3; ++k)
    if (periodic[static_cast<std::size_t>(k)]) result -= cells[k] * edges.col(k);
  if (!orthogonal()) return result;
  for (int k = 0; k < 3; ++k) {
    if (!periodic[static_cast<std::size_t>(k)]) continue;
    // Rounding may leave the copy a hair outside of the half-open interval.
    if (result[k] >= origin[k] + edges(k, k)) result[k] = origin[k];
    if (result[k] < origin[k]) result[k] = origin[k];
  }
  return result;
}

LatticeChange reduce(PeriodicCell& cell) {
  LatticeChange change;
  // Each step shortens an edge by a part that rounding cannot hide, so it ends.
  for (bool again = !cell.orthogonal(); again;) {
    again = false;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        if (i == j || !cell.periodic[static_cast<std::size_t>(i)] ||
            !cell.periodic[static_cast<std::size_t>(j)])
          continue;
        const double part = cell.edges.col(i).dot(cell.edges.col(j)) / cell.edges.col(j).squaredNorm();
        if (!(std::abs(part) > most_slanted)) continue;
        const double times = std::round(part);
        cell.edges.col(i) -= times * cell.edges.col(j);
        cell.rate.col(i) -= times * cell.rate.col(j);
        // N ← N (1 - m e_j e_iᵀ), N⁻¹ ← (1 + m e_j e_iᵀ) N⁻¹
        const auto m = static_cast<int>(times);
        change.edges.col(i) -= m * change.edges.col(j);
        change.images.row(j) += m * change.images.row(i);
        again = true;
      }
  }
  return change;
}

}  // namespace eigengrain::model
