#pragma once

#include "eigengrain/io/scene_reader.hpp"

#include "support/scenes.hpp"

#include <string>

namespace eigengrain::test {

/// Balls of many sizes, pressed in a periodic cube of this edge (m): some 130 at 45 mm, some 1,000 at 90.
inline System pressed_packing(const std::string& edge = "45 mm",
                              const std::string& law = "ks: 5e4, friction: 0.5") {
  return System(assembly::build_model(io::read_scene_text(
      "materials: [{name: grain, density: 2500}]\n"
      "contacts: [{between: [grain, grain], law: linear, kn: 1e5, " +
          law +
          "}]\n"
          "periodic: {box: [" +
          edge + ", " + edge + ", " + edge +
          "]}\n"
          "balls:\n"
          "  - fill: dense\n"
          "    mean_overlap: 1e-3\n"
          "    sizes: {distribution: lognormal, mean: 4.6 mm, deviation: 0.5 mm, min: 3 mm, max: 7 mm}\n"
          "    seed: 1\n"
          "    material: grain\n",
      ".")));
}

}  // namespace eigengrain::test
