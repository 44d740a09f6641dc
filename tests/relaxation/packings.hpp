#pragma once

#include "eigengrain/io/scene_reader.hpp"
#include "eigengrain/model/scene.hpp"

#include <string>

/// Scenes of the thousand balls that settled in a box of 0.1 m (tests/peers/packing_1k.txt).
namespace eigengrain::test {

struct PackedBox {
  std::string contacts = "law: linear, kn: 1.0e5, ks: 5.0e4, friction: 0.5";
  std::string walls = "walls: [{box: {min: [0, 0, 0], max: [0.1, 0.1, 0.2], open: [+z]}, material: grain}]";
};

inline model::Scene packed(const PackedBox& box = {}) {
  return io::read_scene_text(
      "gravity: [0, 0, -9.81]\n"
      "materials: [{name: grain, density: 2500}]\n"
      "contacts: [{between: [grain, grain], " +
          box.contacts +
          "}]\n"
          "balls: [{file: packing_1k.txt, material: grain}]\n"
          "damping: {local: 0.7}\n" +
          box.walls,
      EIGENGRAIN_TEST_DATA "/../peers", "bed");
}

}  // namespace eigengrain::test
