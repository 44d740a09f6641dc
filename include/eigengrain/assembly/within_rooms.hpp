#pragma once

#include "eigengrain/assembly/linear_system.hpp"
#include "eigengrain/assembly/model.hpp"
#include "eigengrain/base/adjacency.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace eigengrain::assembly {

/// The listed contacts at the worst that they can come to while no body leaves its room, nor a wall: those
/// that can touch at the deepest that they can, the others without stiffness. They can turn, too: growth() is
/// what that can do to the block of a body (docs/theory.md, "Tracking").
class WithinRooms {
 public:
  /// Cost O(listed contacts).
  ///
  /// position   [bodies] the middles of their rooms, m; where bodies are now unless can_move()
  /// room       [bodies] how far they can go from there, m
  /// wall_room  how far any wall can go from where it is, m
  WithinRooms(const Model& model, std::vector<Vec3> position, std::vector<double> room, double wall_room);
  WithinRooms(const WithinRooms&) = delete;  // those who prove refer to system()
  WithinRooms& operator=(const WithinRooms&) = delete;

  /// All listed pairs, in their order.
  const LinearSystem& system() const { return system_; }
  const std::vector<Vec3>& position() const { return position_; }
  const std::vector<double>& room() const { return room_; }
  /// [bodies] What eigenvalues of the block of a body, made of the contacts of system(), have to be
  /// multiplied by: 1 + 9 φ, φ the largest angle by which any contact that can touch can turn, or its lever
  /// grow; of clumps 1 + 18 φ (1 + m R²/I).
  const std::vector<double>& growth() const { return growth_; }

  /// Whether single bodies can be given other rooms: not where contacts depend on more than on rooms (clumps,
  /// bonds, walls that move).
  static bool can_move(const Model& model);
  /// Gives bodies other rooms, those in `position` and `room` [all bodies]; the model's list has to be the
  /// one of before. Returns the contacts that have become others, sorted: growth() of their bodies has, too.
  /// Cost O(their contacts).
  std::vector<std::int32_t> move(const Model& model, std::span<const std::int32_t> bodies,
                                 std::span<const Vec3> position, std::span<const double> room);

 private:
  template <class Group>
  void renew(const Model& model, const Group& group, std::size_t c, std::int32_t element);
  void renew_growth(const model::Clumps& clumps, std::int32_t body);

  LinearSystem system_;
  std::vector<Vec3> position_;
  std::vector<double> room_;
  double wall_room_;
  std::vector<double>
      turn_;        ///< [ends] φ, of contact c at 2c and 2c + 1, as its first and second body see it
  Adjacency ends_;  ///< of bodies
  std::vector<double> growth_;
};

}  // namespace eigengrain::assembly
