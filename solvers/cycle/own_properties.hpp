#pragma once

#include "eigengrain/assembly/loads.hpp"
#include "eigengrain/assembly/local_damping.hpp"
#include "eigengrain/assembly/model.hpp"

#include <cstddef>

namespace eigengrain::cycle {

/// Bodies that differ in nothing but mass and place: no applied loads, one α, and inertial masses that are
/// the true ones.
class AllAlike {
 public:
  explicit AllAlike(const assembly::Model& model) : model_(model) {}

  double damping(std::size_t /*row*/) const { return model_.local_damping; }
  double mass(std::size_t row) const { return model_.bodies.mass[row]; }
  double moment_of_inertia(std::size_t row) const { return model_.bodies.inertia[row]; }
  Vec3 load(std::size_t row) const { return model_.bodies.mass[row] * model_.gravity; }
  const Vec3& with_applied(std::size_t /*row*/, const Vec3& moment) const { return moment; }
  template <class Work>
  void count_applied(std::size_t /*row*/, const Vec3& /*velocity*/, const Vec3& /*spin*/,
                     Work& /*work*/) const {}

 private:
  const assembly::Model& model_;
};

/// Bodies of which some have loads, an α or an inertial mass of their own.
class EachItsOwn {
 public:
  explicit EachItsOwn(const assembly::Model& model) : model_(model) {}

  /// Whether a model needs it.
  static bool needed(const model::Bodies& bodies) {
    return assembly::has_loads(bodies) || !bodies.damping.empty() || !bodies.mass_factor.empty();
  }

  double damping(std::size_t row) const { return assembly::damping_of(model_, row); }
  double mass(std::size_t row) const { return model::inertial_mass(model_.bodies, row); }
  double moment_of_inertia(std::size_t row) const { return model::inertial_moment(model_.bodies, row); }
  Vec3 load(std::size_t row) const { return assembly::load_on(model_, row); }
  Vec3 with_applied(std::size_t row, const Vec3& moment) const {
    return moment + assembly::moment_on(model_, row);
  }
  /// The work of the applied force and moment of a row, with a velocity and spin of the step ahead.
  template <class Work>
  void count_applied(std::size_t row, const Vec3& velocity, const Vec3& spin, Work& work) const {
    const model::Bodies& bodies = model_.bodies;
    if (!bodies.applied_force.empty()) work.applied(bodies.applied_force[row], velocity);
    if (!bodies.applied_moment.empty()) work.applied(bodies.applied_moment[row], spin);
  }

 private:
  const assembly::Model& model_;
};

}  // namespace eigengrain::cycle
