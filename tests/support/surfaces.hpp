#pragma once

#include "eigengrain/model/surface.hpp"

#include <cmath>
#include <functional>
#include <numbers>

/// Surfaces of known shape for tests.
namespace eigengrain::test {

/// A square grid of `cells` × `cells` cells about the origin, two triangles each, of height z(x, y), facing
/// up. Diagonals run both ways, so that corners have four to eight triangles.
inline model::Surface terrain(int cells, double cell, const std::function<double(double, double)>& z) {
  model::Surface surface;
  const auto at = [&](int i, int j) { return i * (cells + 1) + j; };
  for (int i = 0; i <= cells; ++i)
    for (int j = 0; j <= cells; ++j) {
      const double x = (i - 0.5 * cells) * cell;
      const double y = (j - 0.5 * cells) * cell;
      surface.vertices.emplace_back(x, y, z(x, y));
    }
  for (int i = 0; i < cells; ++i)
    for (int j = 0; j < cells; ++j) {
      const int a = at(i, j);
      const int b = at(i + 1, j);
      const int c = at(i + 1, j + 1);
      const int d = at(i, j + 1);
      if ((i + j) % 2 == 0) {
        surface.triangles.push_back({a, b, c});
        surface.triangles.push_back({a, c, d});
      } else {
        surface.triangles.push_back({a, b, d});
        surface.triangles.push_back({b, c, d});
      }
    }
  return surface;
}

inline model::Surface flat(int cells, double cell) {
  return terrain(cells, cell, [](double, double) { return 0.0; });
}

/// The box [-half, half] of 12 triangles that face outwards, or inwards.
inline model::Surface cuboid(const Vec3& half, bool inwards = false) {
  model::Surface surface;
  for (int k = 0; k < 8; ++k)
    surface.vertices.emplace_back((k & 1 ? 1 : -1) * half[0], (k & 2 ? 1 : -1) * half[1],
                                  (k & 4 ? 1 : -1) * half[2]);
  surface.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                       {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  if (inwards)
    for (model::Triangle& t : surface.triangles) std::swap(t[1], t[2]);
  return surface;
}

/// The inside of a cylinder about y, open at its ends, of `sides` flat strips.
inline model::Surface tube(int sides, double radius, double length) {
  model::Surface surface;
  for (int k = 0; k < sides; ++k)
    for (const double y : {-0.5 * length, 0.5 * length}) {
      const double angle = 2 * std::numbers::pi * k / sides;
      surface.vertices.emplace_back(radius * std::cos(angle), y, radius * std::sin(angle));
    }
  for (int k = 0; k < sides; ++k) {
    const int a = 2 * k;
    const int b = 2 * ((k + 1) % sides);
    surface.triangles.push_back({a, b, a + 1});
    surface.triangles.push_back({b, b + 1, a + 1});
  }
  return surface;
}

inline void transform(model::Surface& surface, const Mat3& rotation, const Vec3& shift) {
  for (Vec3& x : surface.vertices) x = rotation * x + shift;
}

}  // namespace eigengrain::test
