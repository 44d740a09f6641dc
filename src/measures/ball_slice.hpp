#pragma once

#include <span>

namespace eigengrain::measures {

struct Disc {
  double y;
  double z;
  double radius;
};

/// Area of a union of discs, and ∫ of y, z, yy, yz, zz over it.
struct SliceMoments {
  double area = 0;
  double y = 0;
  double z = 0;
  double yy = 0;
  double yz = 0;
  double zz = 0;
};

/// By Green's theorem along the arcs of the boundary: ∫ ∂P/∂y dA = ∮ P dz, exact to rounding.
SliceMoments slice_moments(std::span<const Disc> discs);

}  // namespace eigengrain::measures
