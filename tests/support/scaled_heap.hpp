#pragma once

#include <string>

namespace eigengrain::test {

/// The scene of two sizes of balls and a clump that fall onto a floor, with an entry of mass_scaling and the
/// law of all contacts.
inline std::string scaled_heap(const std::string& scaling, const std::string& law) {
  return R"(
gravity: [0, 0, -9.81]
materials: [{name: grain, density: 2500}]
periodic: {box: [0.06, 0.06, 1], axes: [x, y]}
balls:
  - {position: [0.05, 0.05, 0.006], radius: 5 mm, material: grain}
  - {position: [0.05, 0.051, 0.0128], radius: 2 mm, material: grain}
clumps:
  - balls: [{at: [0, 0, 0], radius: 5 mm}, {at: [6 mm, 0, 0], radius: 4 mm}, {at: [1 mm, 6 mm, 2 mm], radius: 3 mm}]
    material: grain
    instances: [{position: [0.02, 0.02, 0.01]}, {position: [0.045, 0.02, 0.01]}, {position: [0.03, 0.02, 0.03]}]
walls: [{plane: {point: [0, 0, 0], normal: [0, 0, 1]}, material: grain}]
mass_scaling: )" +
         scaling + "\ncontacts: [{between: [any, any], " + law + "}]\n";
}

}  // namespace eigengrain::test
