#include "wrap.hpp"

#include "eigengrain/contact/state_numbers.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <vector>

namespace eigengrain::assembly {
namespace {

using contact::Pair;
using model::LatticeChange;

/// The state of a contact whose sides have changed places: its vectors are those of a on b.
template <class Law>
typename Law::State mirrored(const typename Law::State& state) {
  std::vector<contact::NamedNumbers> numbers = contact::numbers_of<Law>(state);
  std::size_t field = 0;
  for (contact::NamedNumbers& part : numbers)
    if (Law::state_fields[field++].components == 3)
      for (double& value : part.value) value = -value;
  typename Law::State result = state;
  contact::take_numbers<Law>(numbers, result);
  return result;
}

/// A body and its own image are listed once, by the image that lies ahead; with other edges that may be the
/// other one. Bonds beside a law are found by nobody, and stay as they are.
template <class Group>
void list_own_images_ahead(Group& group) {
  using Law = typename Group::LawType;
  if constexpr (contact::is_beside_law<Law>) return;
  for (std::size_t c = 0; c < group.pairs.size(); ++c) {
    Pair& pair = group.pairs[c];
    if (pair.a != pair.b || pair.image > model::Image{}) continue;
    for (std::int8_t& i : pair.image) i = static_cast<std::int8_t>(-i);
    group.states[c] = mirrored<Law>(group.states[c]);
  }
}

/// An image where its two bodies have been moved by whole cells, and the edges changed before.
model::Image moved_image(const model::Image& image, const LatticeChange& change,
                         const std::array<int, 3>& moved_a, const std::array<int, 3>& moved_b) {
  const Eigen::Vector3i other = change.images * Eigen::Vector3i(image[0], image[1], image[2]);
  model::Image result;
  for (std::size_t k = 0; k < 3; ++k)
    result[k] = static_cast<std::int8_t>(other[static_cast<Eigen::Index>(k)] + moved_b[k] - moved_a[k]);
  return result;
}

}  // namespace

void wrap(Model& model) {
  if (!model.cell.any()) return;
  const LatticeChange change = model::reduce(model.cell);
  const model::PeriodicCell& cell = model.cell;
  constexpr double farthest = 1e9;  // cells
  std::vector<std::array<int, 3>> moved(model.bodies.position.size());
  model::Bodies& bodies = model.bodies;
  const std::vector<Vec3> centres = bodies.clumps.position;  // before they move
  // An image has the velocity of its body and that of its cell.
  const bool moving = !cell.rate.isZero(0) && !bodies.velocity.empty();
  const auto move = [&](const Vec3& reference, Vec3& x, Vec3* velocity, std::array<int, 3>& by) {
    const Vec3 cells = cell.cell_of(reference);
    for (int k = 0; k < 3; ++k) {
      // A centre that is not a number, or lost, stays: the search finds it and says so.
      if (!cell.periodic[k] || !(std::abs(cells[k]) < farthest)) continue;
      by[k] = static_cast<int>(cells[k]);
      x -= by[k] * cell.edges.col(k);
      if (velocity != nullptr) *velocity -= by[k] * cell.rate.col(k);
    }
  };
  for (std::size_t i = 0; i < moved.size(); ++i) {
    const std::int32_t clump = bodies.clumps.of(static_cast<std::int32_t>(i));
    const Vec3 reference = clump == model::Clumps::none ? bodies.position[i] : centres[clump];
    move(reference, bodies.position[i], moving ? &bodies.velocity[i] : nullptr, moved[i]);
  }
  for (std::size_t c = 0; c < centres.size(); ++c) {
    std::array<int, 3> by{};
    move(centres[c], bodies.clumps.position[c], moving ? &bodies.clumps.velocity[c] : nullptr, by);
  }
  model.contacts.for_each_group([&](auto& group) {
    if constexpr (std::decay_t<decltype(group)>::KinematicsType::second_is_body) {
      for (Pair& pair : group.pairs)
        pair.image = moved_image(pair.image, change, moved[pair.a], moved[pair.b]);
      if (change.any()) list_own_images_ahead(group);
    } else if constexpr (std::is_same_v<typename std::decay_t<decltype(group)>::KinematicsType,
                                        contact::BallFacet>) {
      for (Pair& pair : group.pairs)
        for (std::size_t k = 0; k < 3; ++k)
          pair.image[k] = static_cast<std::int8_t>(pair.image[k] - moved[pair.a][k]);
    }
  });
}

}  // namespace eigengrain::assembly
