#pragma once

#include "eigengrain/assembly/state.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace eigengrain::relaxation {

/// Bodies that are pushed or turned by more than a force (moments count over the radius), or that fall:
/// nothing touches them. A clump is one body.
struct Movers {
  std::vector<std::int32_t> bodies;  ///< rows, of clumps those of their holders, in storage order
  double moving = 0;                 ///< the same sum of these, N
  double rest = 0;  ///< sum of the pushes on all others, or of their turns if that is more, N
};
Movers movers_of(const assembly::State& state, double force);

/// A few moving bodies of a packing and what surrounds them, as a state of its own: the movers and their
/// neighbours are free, the next ring is held, all others are left out. Where a handful of balls still roll
/// on a bed at rest, cycles of this part cost next to nothing beside cycles of the whole.
class Part {
 public:
  /// Lists the contacts of the whole anew. Neighbours are bodies whose surfaces are less than the mean radius
  /// of the movers apart, so that nothing outside the part is touched while has_room().
  Part(assembly::State& whole, std::span<const std::int32_t> movers);

  assembly::State& state() { return state_; }
  /// Whether everything in a state that came from this part is near enough to where it was at first.
  bool has_room(const assembly::State& state) const;
  /// Brings what the part has become, velocities, contacts and bonds with their history and bonds that broke,
  /// back into the whole, and forces up to date. The whole must be as the constructor left it.
  void put_back(const assembly::State& part, assembly::State& whole) const;

 private:
  std::vector<std::int32_t> bodies_;  ///< rows of the whole
  std::vector<std::int32_t> clumps_;  ///< clumps of the whole
  std::vector<char> free_;            ///< [bodies of the part] not held
  std::vector<Vec3> position_;        ///< [bodies of the part] at first, m
  double room_ = 0;                   ///< m
  assembly::State state_;
};

}  // namespace eigengrain::relaxation
