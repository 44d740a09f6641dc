#pragma once

#include "eigengrain/base/vec.hpp"
#include "eigengrain/model/clumps.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace eigengrain::model {

/// Components of a body's motion that keep their given velocity: bits 0-2 translation x, y, z, bits 3-5
/// rotation x, y, z.
class FixedComponents {
 public:
  constexpr FixedComponents() = default;
  constexpr explicit FixedComponents(std::uint8_t bits) : bits_(bits) {}

  constexpr std::uint8_t bits() const { return bits_; }
  constexpr std::uint8_t translation() const { return bits_ & 7U; }
  constexpr std::uint8_t rotation() const { return static_cast<std::uint8_t>(bits_ >> 3U) & 7U; }
  constexpr bool all() const { return bits_ == 63; }
  constexpr bool component(int k) const { return ((bits_ >> k) & 1U) != 0; }
  constexpr void fix(int k) { bits_ = static_cast<std::uint8_t>(bits_ | (1U << k)); }
  constexpr FixedComponents with(FixedComponents other) const {
    return FixedComponents(static_cast<std::uint8_t>(bits_ | other.bits_));
  }
  constexpr FixedComponents without(FixedComponents other) const {
    return FixedComponents(static_cast<std::uint8_t>(bits_ & ~other.bits_));
  }
  friend constexpr bool operator==(FixedComponents, FixedComponents) = default;

 private:
  std::uint8_t bits_ = 0;
};

/// The free components of a vector of translation or rotation, zeros at the fixed ones.
inline Vec3 free_part(const Vec3& v, std::uint8_t fixed) {
  Vec3 result = v;
  for (int k = 0; k < 3; ++k)
    if (((fixed >> k) & 1) != 0) result[k] = 0;
  return result;
}

/// Balls in contiguous columns, one row a ball: a body of its own, or a piece of a clump.
/// The order of the rows is a storage order (see sort_along_curve); identity never changes.
struct Bodies {
  std::vector<std::int64_t> identity;  ///< the place in the scene, from 0
  std::vector<Vec3> position;          ///< centre of mass, m
  std::vector<double> radius;          ///< m
  std::vector<double> mass;            ///< kg
  std::vector<double> inertia;         ///< about any axis through the centre (spheres), kg m²
  std::vector<std::int32_t> material;  ///< index into Scene::materials
  std::vector<FixedComponents> fixed;
  std::vector<Vec3> velocity;     ///< m/s; empty: all at rest
  std::vector<Vec3> spin;         ///< angular velocity, rad/s; empty: nothing turns
  std::vector<Quat> orientation;  ///< from the body's frame to space, unit; empty: nothing asks for it
  Clumps clumps;                  ///< which balls move together

  std::int32_t size() const { return static_cast<std::int32_t>(position.size()); }
};

/// Mass and moment of inertia of a homogeneous solid sphere: m = 4/3 π R³ ρ, I = 2/5 m R².
double sphere_mass(double radius, double density);
double sphere_inertia(double radius, double mass);

/// The same of a disk of unit thickness about its axis: m = π R² ρ · 1 m, I = 1/2 m R².
double disk_mass(double radius, double density);
double disk_inertia(double radius, double mass);

/// Multiplies the radius of a ball or disk; mass and moment of inertia follow at its density.
void scale_radius(Bodies& bodies, std::size_t row, double factor);

/// A clump as its balls and mass properties, about the centre of mass and in principal axes.
struct ClumpShape {
  std::vector<Vec3> place;      ///< centres of the balls, m
  std::vector<double> radius;   ///< [balls] m
  double mass = 0;              ///< kg
  double volume = 0;            ///< m³
  Vec3 inertia = Vec3::Zero();  ///< principal moments, kg m²
};

/// Where a clump starts, and how it moves.
struct ClumpStart {
  Vec3 position = Vec3::Zero();         ///< of the centre of mass, m
  Quat orientation = Quat::Identity();  ///< from the principal axes to space
  Vec3 velocity = Vec3::Zero();         ///< m/s
  Vec3 spin = Vec3::Zero();             ///< rad/s
  std::int32_t material = 0;
  FixedComponents fixed{};
};

/// Adds a clump and its balls, as the last rows. Rotations are fixed all or none.
void add_clump(Bodies& bodies, const ClumpShape& shape, const ClumpStart& start);

/// Q I Qᵀ w: the angular momentum of a clump that turns with w, kg m²/s.
Vec3 angular_momentum(const Clumps& clumps, std::int32_t clump, const Vec3& spin);
/// Its inverse, rad/s.
Vec3 angular_velocity(const Clumps& clumps, std::int32_t clump);

/// Puts the balls of all clumps where position and orientation of these say.
void place_members(Bodies& bodies);

/// The centre of mass of the body that a ball is, or is a piece of, m.
inline const Vec3& centre_of(const Bodies& bodies, std::int32_t row) {
  const std::int32_t clump = bodies.clumps.of(row);
  return clump == Clumps::none ? bodies.position[static_cast<std::size_t>(row)]
                               : bodies.clumps.position[static_cast<std::size_t>(clump)];
}

/// Puts the bodies in the order of a space-filling (Morton) curve, so that neighbours in space are
/// neighbours in memory. Depends on positions and identities only.
void sort_along_curve(Bodies& bodies);

/// Row r of the result is row order[r] of the bodies given.
Bodies reordered(const Bodies& bodies, std::span<const std::int32_t> order);

}  // namespace eigengrain::model
