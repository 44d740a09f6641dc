#pragma once

#include "eigengrain/base/vec.hpp"
#include "eigengrain/contact/bonds/bond.hpp"
#include "eigengrain/contact/law.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <span>

namespace eigengrain::contact {

/// The cross-section of a cemented disk: A = πR̄², I = πR̄⁴/4, J = πR̄⁴/2.
struct DiskSection {
  explicit DiskSection(double disk_radius)
      : radius(disk_radius),
        area(std::numbers::pi * radius * radius),
        inertia(0.25 * area * radius * radius),
        polar_inertia(2 * inertia) {}

  double radius;         ///< R̄, m
  double area;           ///< A, m²
  double inertia;        ///< I, m⁴, of bending
  double polar_inertia;  ///< J, m⁴, of twist
};

/// Forces and moments that a disk carries.
struct DiskLoad {
  double normal = 0;   ///< F_n, N, compression positive
  double shear = 0;    ///< |F_s|, N
  double twist = 0;    ///< |M_n|, N m
  double bending = 0;  ///< |M_s|, N m
};

/// Material of a parallel bond, what both of its forms share.
struct Cement {
  double radius = 1;                                         ///< λ: R̄ = λ min(R_a, R_b)
  double kn = 0;                                             ///< k̄_n, Pa/m
  double ks = 0;                                             ///< k̄_s, Pa/m
  double tension = std::numeric_limits<double>::infinity();  ///< tensile strength, Pa
  double shear = std::numeric_limits<double>::infinity();    ///< shear strength, Pa

  /// values  the first five of `parameters`
  static Cement from_values(std::span<const double> values) {
    return {.radius = values[0], .kn = values[1], .ks = values[2], .tension = values[3], .shear = values[4]};
  }

  Cement unbreakable() const { return {.radius = radius, .kn = kn, .ks = ks}; }

  double disk_radius(const BondSite& site) const { return radius * std::min(site.radius_a, site.radius_b); }

  /// k̄_n A, k̄_s A, twist k̄_s J, bending k̄_n I (PFC3D eq. 1.34).
  ContactStiffness stiffness(const DiskSection& disk) const {
    return {.normal = kn * disk.area,
            .shear = ks * disk.area,
            .twist = ks * disk.polar_inertia,
            .bending = kn * disk.inertia};
  }

  /// The largest stresses, by beam theory, against the strengths:
  ///   -F_n/A + |M_s| R̄/I  against tension,   |F_s|/A + |M_n| R̄/J  against shear.
  /// Where both are reached at once, the one that is exceeded by more.
  std::optional<BreakMode> failure(const DiskSection& disk, const DiskLoad& load) const {
    const double tensile = (-load.normal / disk.area + load.bending * disk.radius / disk.inertia) / tension;
    const double sheared = (load.shear / disk.area + load.twist * disk.radius / disk.polar_inertia) / shear;
    if (std::max(tensile, sheared) < 1) return std::nullopt;
    return tensile >= sheared ? BreakMode::tension : BreakMode::shear;
  }

  static constexpr std::string_view name = "parallel";
  static constexpr std::string_view description =
      "a cemented disk between two balls, beside their contact law: it carries force and moment, and breaks";
  static constexpr std::array<ParameterDescription, 6> parameters{{
      {.name = "radius",
       .unit = "",
       .default_value = 1,
       .minimum = 0,
       .minimum_allowed = false,
       .description = "radius of the disk over that of the smaller ball"},
      {.name = "kn",
       .unit = "Pa/m",
       .minimum = 0,
       .minimum_allowed = false,
       .description = "normal stiffness per area; bending has it too"},
      {.name = "ks",
       .unit = "Pa/m",
       .default_value = 0,
       .minimum = 0,
       .description = "shear stiffness per area; twist has it too"},
      {.name = "tension",
       .unit = "Pa",
       .default_value = std::numeric_limits<double>::infinity(),
       .minimum = 0,
       .minimum_allowed = false,
       .description = "tensile strength; absent: it does not break so"},
      {.name = "shear",
       .unit = "Pa",
       .default_value = std::numeric_limits<double>::infinity(),
       .minimum = 0,
       .minimum_allowed = false,
       .description = "shear strength; absent: it does not break so"},
      {.name = "incremental",
       .kind = ParameterDescription::Kind::flag,
       .unit = "",
       .default_value = 0,
       .description =
           "sum up increments, as PFC3D does, not from the relative position and orientation since "
           "the bond was made; it drifts in large rotations"},
  }};
};

}  // namespace eigengrain::contact
