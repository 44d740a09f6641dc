// Planar scenes against closed forms: three unknowns a body.
#include "eigengrain/assembly/model.hpp"
#include "eigengrain/io/scene_reader.hpp"
#include "eigengrain/timestep/comparison.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>
#include <string>

namespace eigengrain::test {
namespace {

/// Balls of radius 0.5 m and of mass 1 kg, which touch in a periodic box, with k_n = 1 N/m.
struct Crystal {
  int columns;
  int rows;
  double row_height;  ///< over the diameter
  double shift;       ///< of every other row, over the diameter
};
constexpr Crystal square{4, 4, 1, 0};
constexpr Crystal hexagonal{4, 4, std::numbers::sqrt3 / 2, 0.5};

std::string scene_of(const Crystal& crystal, bool disks, double ks) {
  constexpr double distance = 1 - 1e-12;
  const double solid = disks ? std::numbers::pi / 4 : std::numbers::pi / 6;
  std::string text = fmt::format(
      "planar: {{shape: {}}}\n"
      "materials: [{{name: grain, density: {:.17g}}}]\n"
      "contacts: [{{between: [any, any], law: linear, kn: 1, ks: {}, friction: 1}}]\n"
      "periodic: {{box: [{:.17g}, {:.17g}, 0], axes: [x, y]}}\nballs:\n",
      disks ? "disk" : "sphere", 1 / solid, ks, crystal.columns * distance,
      crystal.rows * crystal.row_height * distance);
  for (int row = 0; row < crystal.rows; ++row)
    for (int column = 0; column < crystal.columns; ++column)
      text += fmt::format("  - {{position: [{:.17g}, {:.17g}, 0], radius: 0.5, material: grain}}\n",
                          (column + 0.25 + crystal.shift * (row % 2)) * distance,
                          (row + 0.25) * crystal.row_height * distance);
  return text;
}

double lambda_max(const Crystal& crystal, bool disks, double ks) {
  const timestep::Comparison c =
      timestep::compare(assembly::build_model(io::read_scene_text(scene_of(crystal, disks, ks), ".")));
  EXPECT_EQ(c.bodies, crystal.columns * crystal.rows);
  EXPECT_EQ(c.unknowns, (ks > 0 ? 3 : 2) * c.bodies);
  return c.truth.lambda_max;
}

// Twice the coordination number, or half of it, in k_s m/I R² where all turn alike: I = ½ m R² or ⅖ m R².
TEST(Planar, LatticesOfDisksAndSpheresHaveTheirCriticalSteps) {
  // Square: 4 (k_n + k_s) of the shortest wave, against 16 k_s (disks) and 20 k_s (spheres) of the spin.
  for (const double ks : {0.0, 0.2, 0.5, 1.0}) {
    EXPECT_NEAR(lambda_max(square, true, ks) / std::max(4 * (1 + ks), 16 * ks), 1, 1e-9) << ks;
    EXPECT_NEAR(lambda_max(square, false, ks) / std::max(4 * (1 + ks), 20 * ks), 1, 1e-9) << ks;
  }
  // Hexagonal: 6 k_n without shear, 24 k_s and 30 k_s of the spin from k_s = k_n/2 on.
  EXPECT_NEAR(lambda_max(hexagonal, true, 0), 6, 1e-8);
  for (const double ks : {0.5, 2.0 / 3, 1.0}) {
    EXPECT_NEAR(lambda_max(hexagonal, true, ks) / (24 * ks), 1, 1e-9) << ks;
    EXPECT_NEAR(lambda_max(hexagonal, false, ks) / (30 * ks), 1, 1e-9) << ks;
  }
}

}  // namespace
}  // namespace eigengrain::test
