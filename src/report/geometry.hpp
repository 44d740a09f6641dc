#pragma once

#include <algorithm>
#include <cmath>

/// Places in a picture: x to the right, y downwards, in units of the picture (at a screen, pixels).
namespace eigengrain::report {

struct Place {
  double x = 0;
  double y = 0;
};

struct Line {
  Place from;
  Place to;
};

struct Box {
  double left = 0;
  double top = 0;
  double right = 0;
  double bottom = 0;

  double width() const { return right - left; }
  double height() const { return bottom - top; }
  bool overlaps(const Box& other) const {
    return left < other.right && other.left < right && top < other.bottom && other.top < bottom;
  }
  bool holds(const Box& other) const {
    return left <= other.left && other.right <= right && top <= other.top && other.bottom <= bottom;
  }
  Box grown(double by) const { return {left - by, top - by, right + by, bottom + by}; }
  static Box about(const Place& centre, double half) {
    return {centre.x - half, centre.y - half, centre.x + half, centre.y + half};
  }
};

/// Whether the segment from a to b has a point inside the box (Liang and Barsky, 1984).
bool crosses(const Box& box, const Place& a, const Place& b);

}  // namespace eigengrain::report
