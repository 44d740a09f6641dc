#pragma once

#include "eigengrain/contact/orientation.hpp"

#include "support/scenes.hpp"
#include "support/tangents.hpp"

#include <limits>
#include <numbers>
#include <random>

/// Scenes with bonds for tests.
namespace eigengrain::test {

/// A parallel bond by the stiffness of a disk of radius 1: k_n = k̄_n A, k_s = k̄_s A.
struct Cemented {
  double kn = 1;
  double ks = 0.6;
  double tension = std::numeric_limits<double>::infinity();  ///< Pa
  double shear = std::numeric_limits<double>::infinity();    ///< Pa
  double radius = 1;                                         ///< λ
  bool incremental = false;
  double gap = 1e-9;

  model::BondRule rule() const {
    return {.kind = "parallel",
            .parameters = {radius, kn / std::numbers::pi, ks / std::numbers::pi, tension, shear,
                           incremental ? 1.0 : 0.0},
            .gap = gap};
  }
};

/// Moves and turns bodies where they stand, without a step.
inline void deform(assembly::Model& model, std::mt19937_64& random, double shift, double turn) {
  for (std::size_t i = 0; i < model.bodies.position.size(); ++i) {
    model.bodies.position[i] += shift * random_vector(random);
    model.bodies.orientation[i] = contact::turned(model.bodies.orientation[i], turn * random_vector(random));
  }
}

}  // namespace eigengrain::test
