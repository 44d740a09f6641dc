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

/// A ball whose radius is changed in time, linearly from its first value to `factor` times that; its mass and
/// moment follow at constant density.
struct RadiusRamp {
  double radius = 0;   ///< at first, m
  double mass = 0;     ///< at first, kg
  double inertia = 0;  ///< at first, kg m²
  double factor = 1;   ///< radius at the end over that at first; 1: stays
  double from = 0;     ///< when it begins, s
  double over = 1;     ///< how long it takes, s

  /// Present radius over the first one.
  double scale(double time) const;
};

/// Balls in contiguous columns, one row a ball: a body of its own, or a piece of a clump.
/// The order of the rows is a storage order (see sort_along_curve); identity never changes.
///
/// Columns that may be empty are there only where some body has need of them.
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
  /// Constant, through the centre of mass; of a clump in the row of its holder, N; empty: none
  std::vector<Vec3> applied_force;
  std::vector<Vec3> applied_moment;  ///< the same, N m
  std::vector<double> damping;       ///< α of local damping, or scene_damping; empty: all have the scene's
  std::vector<RadiusRamp> ramp;      ///< empty: radii stay
  /// Inertial over true mass and moment (density scaling), of a clump in all its rows; empty: 1
  std::vector<double> mass_factor;
  Clumps clumps;  ///< which balls move together

  /// Stands in `damping` for the α of the scene.
  static constexpr double scene_damping = -1;

  std::int32_t size() const { return static_cast<std::int32_t>(position.size()); }
};

/// Adds the row behind `rows` rows to a column that is there only if some body needs it: rows that it does
/// not have yet get the value of those that have no need.
template <class T>
void add_row(std::vector<T>& column, std::int32_t rows, const T& value, const T& no_need) {
  if (column.empty() && value == no_need) return;
  column.resize(static_cast<std::size_t>(rows), no_need);
  column.push_back(value);
}

/// Mass and moment of inertia of a homogeneous solid sphere: m = 4/3 π R³ ρ, I = 2/5 m R².
double sphere_mass(double radius, double density);
double sphere_inertia(double radius, double mass);

/// The same of a disk of unit thickness about its axis: m = π R² ρ · 1 m, I = 1/2 m R².
double disk_mass(double radius, double density);
double disk_inertia(double radius, double mass);

/// Multiplies the radii of some balls, none of them a piece of a clump, by a factor. Density stays: m ∝ R³
/// and I ∝ R⁵, of disks (I = 1/2 m R²) m ∝ R² and I ∝ R⁴. Velocities stay, and so does the course of ramps.
/// Whoever does this to a model in motion lists its contacts anew (assembly::renew_list).
void scale_radii(Bodies& bodies, std::span<const std::int32_t> rows, double factor);

/// Radii, masses and moments of balls with ramps at a time (s). Returns the greatest change of a radius, m.
double set_radii(Bodies& bodies, double time);
/// Whether some radius changes between two times, s.
bool radii_change(const Bodies& bodies, double begin, double end);

/// Inertial over true mass of a body.
inline double mass_factor_of(const Bodies& bodies, std::size_t row) {
  return bodies.mass_factor.empty() ? 1.0 : bodies.mass_factor[row];
}
/// What a body sets against forces and moments: its mass and moment of inertia, scaled where the scene scales
/// masses. kg, kg m².
inline double inertial_mass(const Bodies& bodies, std::size_t row) {
  return bodies.mass_factor.empty() ? bodies.mass[row] : bodies.mass_factor[row] * bodies.mass[row];
}
inline double inertial_moment(const Bodies& bodies, std::size_t row) {
  return bodies.mass_factor.empty() ? bodies.inertia[row] : bodies.mass_factor[row] * bodies.inertia[row];
}

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
  Vec3 force = Vec3::Zero();   ///< applied at the centre of mass, N
  Vec3 moment = Vec3::Zero();  ///< applied, N m
  double damping = Bodies::scene_damping;
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

/// Adds balls that are no pieces of clumps behind all rows, numbered on; columns that only one side has are
/// filled with what stands for no need.
void append_rows(Bodies& bodies, const Bodies& more);

/// Row r of the result is row order[r] of the bodies given.
Bodies reordered(const Bodies& bodies, std::span<const std::int32_t> order);

}  // namespace eigengrain::model
