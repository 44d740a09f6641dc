#pragma once

#include "eigengrain/base/vec.hpp"
#include "eigengrain/generate/balls.hpp"
#include "eigengrain/generate/region.hpp"

#include <span>
#include <string_view>
#include <vector>

namespace eigengrain::generate {

/// A lattice by its rectangular cell, in units of the distance of nearest neighbours.
struct Lattice {
  std::string_view name;
  Vec3 cell;                ///< edges; along z without meaning where planar
  std::vector<Vec3> sites;  ///< [sites of a cell] fractions of the edges, the least along each axis 0
  bool planar = false;      ///< one layer in a plane z = constant
};

/// All lattices: sc, bcc, fcc, hcp (close-packed layers normal to z), diamond, square, hexagonal.
std::span<const Lattice> lattices();

/// The lattice of that name; nullptr if there is none.
const Lattice* find_lattice(std::string_view name);

/// Equal balls on the sites of a lattice, cell after cell along x, then y, then z.
///
/// radius   m; spacing: distance of nearest neighbours, m
///
/// Along a periodic axis the first site lies on the lower face, and the region must be a whole number of
/// cells long, to 1e-9 of it; positions are then fractions of that length, so that copies fit to rounding.
/// Along the others the first ball touches the lower face, and the last one lies inside (or touches the upper
/// face, to 1e-9 of the spacing). A planar lattice lies midway between the faces in z.
///
/// Throws InputError where a periodic length does not fit, with the nearest one that does, where not one ball
/// has room, and for more than most_balls.
Balls fill_with_lattice(const Lattice& lattice, double radius, double spacing, const Region& region);

}  // namespace eigengrain::generate
