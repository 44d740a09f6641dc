#pragma once

#include "eigengrain/base/vec.hpp"
#include "eigengrain/model/mesh.hpp"

#include <cstdint>
#include <string>
#include <string_view>

namespace eigengrain::model {

/// How stress follows from deformation (fem/material.hpp).
enum class ElasticModel : std::uint8_t { linear, corotational, saint_venant_kirchhoff, neo_hookean };

/// As scene files write it.
constexpr std::string_view name_of(ElasticModel model) {
  switch (model) {
    case ElasticModel::linear:
      return "linear";
    case ElasticModel::saint_venant_kirchhoff:
      return "saint-venant-kirchhoff";
    case ElasticModel::neo_hookean:
      return "neo-hookean";
    case ElasticModel::corotational:
      break;
  }
  return "corotational";
}

/// An isotropic elastic solid.
struct ElasticSolid {
  ElasticModel model = ElasticModel::corotational;
  double young = 0;    ///< Young's modulus E, Pa
  double poisson = 0;  ///< Poisson's ratio ν

  double lame() const { return young * poisson / ((1 + poisson) * (1 - 2 * poisson)); }  ///< λ, Pa
  double shear() const { return 0.5 * young / (1 + poisson); }                           ///< µ, Pa
};

/// A body of finite elements. Its nodes are bodies without size or rotation, one row each: identities
/// `first_node` and on, in the order of the mesh.
struct Deformable {
  std::string name;
  Mesh mesh;  ///< free of stress, where it starts, m
  ElasticSolid solid;
  double density = 0;           ///< kg/m³
  std::int32_t material = 0;    ///< index into Scene::materials, for its contacts
  std::int64_t first_node = 0;  ///< identity
};

}  // namespace eigengrain::model
