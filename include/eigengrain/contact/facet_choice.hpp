#pragma once

#include "eigengrain/contact/kinematics.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

/// Which of the facets near a ball it touches. A ball that rolls over an edge inside a surface must feel no
/// more there than on a face, and keep its history.
namespace eigengrain::contact {

/// A centre that lies on a facet, so that their contact has no direction.
struct CentreOnFacet {
  std::int32_t body = 0;
  std::int32_t facet = 0;
};

/// Directions from a ball to two facets that differ by less than this are one contact (30°).
inline constexpr double one_contact = 0.8660254037844386;

/// Decides, for the pairs of one ball with facets of one surface, on which side the ball is and which of the
/// pairs are contacts, and stores both in their `side`:
///
///   1. Each facet offers its nearest point to the centre: on its face, an edge or a corner.
///   2. The ball is on the side from which it came to a face; where an edge or corner is nearest, on that of
///      the facet that takes it by rule 3, or else on that of the surface's normal there. A one-sided facet
///      offers nothing to a ball behind it.
///   3. An edge or corner counts only where no facet that it belongs to offers a nearer point: an edge gives
///      way to its faces, a corner to its faces and edges (as in the hierarchies of contact detection with
///      meshes, e.g. Hu et al., Comput. Part. Mech. 2015; Kremmer and Favier, Int. J. Numer. Meth. Eng.
///      2001).
///   4. Of points in nearly the same direction (30°) the nearest counts, so that a finely divided hollow is
///      one contact, whose force is continuous, while both walls of a corner are touched.
///
/// directions  [pairs] receives the normal of each as a contact, in the frame of the surface
/// Throws CentreOnFacet. Cost O(pairs²) at worst, for the few facets near a ball.
void choose_facets(const Placement& placement, std::span<Pair> pairs, std::span<Vec3> directions);

namespace detail {

template <class State>
bool is_new(const State& state) {
  const State fresh{};
  return std::memcmp(&state, &fresh, sizeof(State)) == 0;
}

/// Scratch of one thread.
struct FacetScratch {
  std::vector<Vec3> directions;
  std::vector<std::int8_t> before;
};

/// The history of a contact that ends goes to the one that begins in nearly the same direction.
template <class State>
void hand_over(std::span<const Pair> pairs, const FacetScratch& scratch, std::span<State> states) {
  const auto was_on = [&](std::size_t c) { return std::abs(scratch.before[c]) == 1; };
  for (std::size_t c = 0; c < pairs.size(); ++c) {
    if (!pairs[c].is_contact() || was_on(c) || !is_new(states[c])) continue;
    std::size_t nearest = pairs.size();
    double best = one_contact;
    for (std::size_t d = 0; d < pairs.size(); ++d) {
      if (pairs[d].is_contact() || !was_on(d) || is_new(states[d])) continue;
      const double cosine = scratch.directions[c].dot(scratch.directions[d]);
      if (cosine > best) {
        best = cosine;
        nearest = d;
      }
    }
    if (nearest < pairs.size()) states[c] = std::exchange(states[nearest], State{});
  }
  for (std::size_t c = 0; c < pairs.size(); ++c)
    if (!pairs[c].is_contact()) states[c] = State{};
}

}  // namespace detail

/// Chooses the facets for contacts [begin, end) of a group, which hold all pairs of their balls, and carries
/// histories over from facet to facet.
template <class Group>
void follow_facets(const Placement& placement, Group& group, std::size_t begin, std::size_t end) {
  thread_local detail::FacetScratch scratch;
  const auto surface = [&](const Pair& pair) { return placement.facets->facet[pair.b].surface; };
  while (begin < end) {
    std::size_t next = begin + 1;
    while (next < end && group.pairs[next].a == group.pairs[begin].a &&
           surface(group.pairs[next]) == surface(group.pairs[begin]))
      ++next;
    const std::span<Pair> pairs = std::span(group.pairs).subspan(begin, next - begin);
    scratch.directions.resize(pairs.size());
    scratch.before.clear();
    for (const Pair& pair : pairs) scratch.before.push_back(pair.side);
    choose_facets(placement, pairs, scratch.directions);
    if constexpr (!std::is_empty_v<typename Group::State>)
      detail::hand_over<typename Group::State>(pairs, scratch,
                                               std::span(group.states).subspan(begin, next - begin));
    begin = next;
  }
}

}  // namespace eigengrain::contact
