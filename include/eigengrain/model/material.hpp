#pragma once

#include <optional>
#include <string>

namespace eigengrain::model {

/// What balls and walls are made of. What contact laws may take from it is optional.
struct Material {
  std::string name;
  double density = 0;  ///< kg/m³; 0 for a material that only walls are made of
  /// Nothing gives under it: in a contact only the other side does.
  bool rigid = false;
  std::optional<double> young{};    ///< Young's modulus E, Pa
  std::optional<double> poisson{};  ///< Poisson's ratio ν
  std::optional<double> kn{};       ///< stiffness of one side of a linear contact, N/m
  std::optional<double> ks{};       ///< the same across n, N/m
};

}  // namespace eigengrain::model
