#pragma once

#include "eigengrain/assembly/model.hpp"
#include "eigengrain/contact/kinematics.hpp"
#include "eigengrain/contact/law.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace eigengrain::assembly {

/// The contacts that act now or can come to act while no body leaves its room, nor a wall: with the stiffness
/// at the deepest that they can come to, times what the turns of the contacts of a body can add to the
/// eigenvalues of its block: 1 + 9 φ, φ the largest turn of any, at clumps 1 + 18 φ (1 + m R²/I)
/// (docs/theory.md, "Tracking"). To be given to for_each_element in place of Listed.
class WithinRooms {
 public:
  /// Refers to the model and the rooms, which must outlive it. Cost O(listed contacts).
  ///
  /// room       [bodies] m
  /// wall_room  of all walls, m
  WithinRooms(const Model& model, std::span<const double> room, double wall_room);

  /// How much nearer the sides of a pair can come, m.
  double approach(const contact::Pair& pair, bool with_ball) const {
    return room_[static_cast<std::size_t>(pair.a)] +
           (with_ball ? room_[static_cast<std::size_t>(pair.b)] : wall_room_);
  }
  /// What the stiffness of a contact is multiplied by, and so are its dashpots.
  double factor(const contact::Pair& pair, bool with_ball) const;

 private:
  const Model& model_;
  std::span<const double> room_;
  double wall_room_;
  std::vector<double> factor_;  ///< [bodies] holders for clumps
};

template <class Law>
bool counts(const WithinRooms& which, const Law& law, const typename Law::State& state,
            const contact::Pair& pair, bool with_ball, contact::ContactMotion& motion) {
  motion.overlap += which.approach(pair, with_ball);
  return law.acts(motion, state);
}

}  // namespace eigengrain::assembly
