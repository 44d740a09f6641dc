#pragma once

#include "eigengrain/assembly/linear_system.hpp"
#include "eigengrain/assembly/state.hpp"

#include <span>
#include <string>
#include <vector>

/// What an experiment with a state needs: the state at rest and in balance, and motions of it.
namespace eigengrain::timestep {

/// The state at rest, with walls, cell and radii stopped, and with a constant load on every body that cancels
/// contacts and gravity: in balance to rounding. The loads of the scene are replaced.
assembly::State in_balance(assembly::State state);

/// The motion of a state on the unknowns of a system.
class Motion {
 public:
  /// Refers to the system, which is that of the state's model and must outlive it.
  explicit Motion(const assembly::LinearSystem& system) : system_(system) {}

  /// Gives a state the velocities factor · v; those of bodies without unknowns stay.
  void set(assembly::State& state, std::span<const double> v, double factor) const;
  /// y = M^½ v of a state, so that y·y is twice its kinetic energy; zero at masked components.
  void get(const assembly::State& state, std::span<double> y) const;
  /// The largest velocity of any body's surface in v: by translation or by rotation.
  double fastest_surface(const assembly::State& state, std::span<const double> v) const;

 private:
  const assembly::LinearSystem& system_;
};

/// Adds a text to a list that does not have it yet.
void add_once(std::vector<std::string>& all, std::string text);

/// Why small motions about a state are not those of its K, in words; what a run from it shows beside
/// that is added by add_changes.
std::vector<std::string> reservations_about(const assembly::State& state);

/// What a run did to the contacts that linear springs would not: those that opened or formed, slipped, or
/// bonds that broke. Adds it to the reservations, each thing once.
void add_changes(const assembly::State& before, const assembly::State& after,
                 std::vector<std::string>& reservations);

}  // namespace eigengrain::timestep
