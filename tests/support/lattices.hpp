#pragma once

#include "support/scenes.hpp"

#include <array>
#include <cmath>
#include <string>
#include <vector>

/// Periodic lattices of equal spheres (R = 1, m = 1) that just touch: a relative overlap of 1e-12, small
/// enough to leave closed forms untouched to 1e-11 and large enough to survive rounding.
namespace eigengrain::test {

inline constexpr double touching = 1.0 - 1e-12;

/// Sites of the conventional cell, in units of its edges.
struct Lattice {
  std::string name;
  Vec3 cell;                ///< edges for spheres of radius 1 that touch
  std::vector<Vec3> sites;  ///< fractions of the edges
  std::array<bool, 3> periodic{true, true, true};
};

inline Lattice simple_cubic() {
  return {"SC", Vec3::Constant(2), {{0, 0, 0}}};
}
inline Lattice body_centred() {
  return {"BCC", Vec3::Constant(4 / std::sqrt(3.0)), {{0, 0, 0}, {.5, .5, .5}}};
}
inline Lattice face_centred() {
  return {"FCC", Vec3::Constant(2 * std::sqrt(2.0)), {{0, 0, 0}, {.5, .5, 0}, {.5, 0, .5}, {0, .5, .5}}};
}
inline Lattice diamond() {
  Lattice lattice = face_centred();
  lattice.name = "diamond";
  lattice.cell = Vec3::Constant(8 / std::sqrt(3.0));
  for (std::size_t k = 0; k < 4; ++k) lattice.sites.push_back(lattice.sites[k] + Vec3::Constant(.25));
  return lattice;
}
inline Lattice chain() {
  return {"chain", {2, 9, 9}, {{0, 0, 0}}, {true, false, false}};
}
inline Lattice square() {
  return {"square", {2, 2, 9}, {{0, 0, 0}}, {true, true, false}};
}
inline Lattice hexagonal() {
  return {"hexagonal", {2, 2 * std::sqrt(3.0), 9}, {{0, 0, 0}, {.5, .5, 0}}, {true, true, false}};
}

/// cells[k] conventional cells along axis k.
inline SceneBuilder make_lattice(const Lattice& lattice, const Springs& springs, std::array<int, 3> cells,
                                 model::FixedComponents fixed = {}) {
  SceneBuilder builder(springs);
  const Vec3 edge = lattice.cell * touching;
  for (int i = 0; i < cells[0]; ++i)
    for (int j = 0; j < cells[1]; ++j)
      for (int k = 0; k < cells[2]; ++k)
        for (const Vec3& site : lattice.sites)
          builder.ball((site + Vec3(i, j, k) + Vec3::Constant(0.01)).cwiseProduct(edge), 1, 1, fixed);
  return builder.periodic(Vec3(cells[0], cells[1], cells[2]).cwiseProduct(edge), lattice.periodic);
}

}  // namespace eigengrain::test
