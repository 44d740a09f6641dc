#pragma once

#include "geometry.hpp"

#include <optional>
#include <span>
#include <vector>

/// Where labels go so that none covers another, or a mark.
namespace eigengrain::report {

/// A mark that wants its name beside it.
struct LabelWish {
  Place mark;
  double width = 0;  ///< of the text
  double height = 0;
};

struct PlacedLabel {
  Box box;
  Place anchor;         ///< the point of the box nearest to the mark
  bool leader = false;  ///< far enough from its mark to need a line to it
};

/// A place for each label, as near to its mark as there is room inside the frame; none where there is no room
/// at all. No two of the boxes overlap, and none overlaps a mark or an obstacle; lines to marks keep clear of
/// other labels where that can be had. Depends on the order: labels with the most neighbours go first.
std::vector<std::optional<PlacedLabel>> place_labels(std::span<const LabelWish> wishes, const Box& frame,
                                                     std::span<const Box> obstacles = {});

/// Numbers as near to the ones given as a distance of at least `gap` allows, between low and high, in the
/// same order. Where all do not fit, they are spread evenly and closer.
std::vector<double> spread(std::span<const double> wished, double gap, double low, double high);

}  // namespace eigengrain::report
