#pragma once

#include "eigengrain/base/vec.hpp"
#include "eigengrain/generate/region.hpp"
#include "eigengrain/model/surroundings.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace eigengrain::generate {

/// Sums over the contacts of some balls; a contact of two balls counts half in each.
struct Overlaps {
  double contacts = 0;
  double ends = 0;          ///< contacts of each ball, summed
  double sum = 0;           ///< of δ, m
  double relative_sum = 0;  ///< of δ relative
  double largest = 0;       ///< relative
  double force = 0;         ///< Σ |f|², m²
  double scaled_force = 0;  ///< Σ |f|²/m
  double power = 0;         ///< Σ f·v

  void add(const Overlaps& other);
};

/// Balls that move to where they overlap least: FIRE on E = Σ δ²/2, with unit stiffness. Balls of n times the
/// usual number of contacts have n times the mass, so that one timestep suits all sizes.
class OverlapMinimiser {
 public:
  OverlapMinimiser(std::vector<Vec3> centres, std::vector<double> radii, const Region& region);

  enum class End { apart, balanced, tired };
  /// Stops when no relative overlap is above `apart`, when the root of the mean square of the forces on balls
  /// is below `balance` of the mean force in contacts, or after so many iterations.
  End minimise(double apart, double balance, std::int64_t most_iterations);

  /// Makes all radii so many times those given at the start.
  void set_scale(double factor);

  std::span<const Vec3> centres() const { return centres_; }
  std::span<const double> radii() const { return radii_; }
  /// As the balls stand.
  Overlaps measure();
  std::int64_t iterations() const { return iterations_; }

 private:
  /// A ball near another: the copy of `ball` in that image.
  struct Neighbour {
    std::int32_t ball = 0;
    model::Image image{};
  };

  void list_neighbours();
  Overlaps forces_on(std::int64_t begin, std::int64_t end);
  void add_faces(std::int64_t ball, Vec3& force, Overlaps& sums) const;
  Overlaps evaluate();
  void stop_and_go_back(double dt);
  void move(double dt, double mixing, double scaled_force);

  Region region_;
  model::PeriodicCell cell_;
  std::vector<Vec3> centres_;  ///< [n] m, not wrapped
  std::vector<double> given_radii_;
  std::vector<double> radii_;  ///< [n] m
  std::vector<double> inverse_mass_;
  std::vector<Vec3> velocity_;
  std::vector<Vec3> force_;
  std::vector<std::int64_t> offsets_;  ///< [n + 1] into neighbours_
  std::vector<Neighbour> neighbours_;
  std::vector<Vec3> listed_at_;  ///< [n] centres when neighbours were listed
  double skin_ = 0;              ///< gap up to which balls are listed, m
  double moved_ = 0;             ///< m, the farthest since
  std::int64_t iterations_ = 0;
};

}  // namespace eigengrain::generate
