// Infinite lattices: the spectrum, one estimate and the cycle against closed forms (docs/theory.md), for four
// ratios of stiffness, with rotation free and held.
#include "hard_cases/hard_case.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

namespace eigengrain::test {
namespace {

struct Lattice {
  std::string name;
  double (*held)(double s);  ///< λ_max m/k_n with rotations held, s = k_s/k_n
  double turning;            ///< of the mode in which all turn alike, over s
  int entries = 1;           ///< of balls in the scene
};

/// The hexagonal lattice at the point M of its zone: with b² of the three bonds along and across the wave,
/// λ is the larger eigenvalue of 2 Σ (n nᵀ + s (1 - n nᵀ))(1 - cos q·n) over bonds, of which two change sign.
double hexagonal_held(double s) {
  return 6 + 2 * s;
}

const std::vector<Lattice>& lattices() {
  static const std::vector<Lattice> all{
      {"lattice_chain", [](double) { return 4.0; }, 10, 4},
      {"lattice_square", [](double s) { return 4 * (1 + s); }, 20},
      {"lattice_hexagonal", hexagonal_held, 30},
      {"lattice_hexagonal_disks", hexagonal_held, 24},
      {"lattice_sc", [](double s) { return 4 * (1 + 2 * s); }, 20},
      {"lattice_bcc", [](double s) { return 16.0 / 3 * (1 + 2 * s); }, 80.0 / 3},
      {"lattice_fcc", [](double s) { return 8 * (1 + s); }, 40},
      {"lattice_diamond", [](double s) { return 8.0 / 3 * (1 + 2 * s); }, 40.0 / 3},
  };
  return all;
}

class LatticeCase : public testing::TestWithParam<Lattice> {};

TEST_P(LatticeCase, HasItsClosedForm) {
  const Lattice& lattice = GetParam();
  for (const double s : {0.0, 0.5, 2.0 / 3, 1.0})
    for (const bool held : {false, true}) {
      std::vector<std::string> overrides{fmt::format("contacts.0.ks={}", s)};
      for (int k = 0; held && k < lattice.entries; ++k)
        overrides.push_back(fmt::format("balls.{}.fix=[wx, wy, wz]", k));
      const assembly::State state = start_of(lattice.name, overrides);
      const timestep::Comparison found = timestep::compare(state.model);
      const double lambda = held ? lattice.held(s) : std::max(lattice.held(s), lattice.turning * s);
      const std::string what =
          fmt::format("{}, s = {}, rotation {}", lattice.name, s, held ? "held" : "free");
      EXPECT_NEAR(found.truth.dt * std::sqrt(lambda) / 2, 1, 1e-9) << what;
      if (!held && lattice.turning * s > lattice.held(s)) {
        EXPECT_NEAR(estimate_named(found, "diagonal").ratio_to_true, std::sqrt(0.5), 1e-9) << what;
      }
      const timestep::EmpiricalLimit runs = timestep::empirical_limit(state, found.truth);
      EXPECT_NEAR(runs.dt / found.truth.dt, 1, 2e-4) << what;
      EXPECT_TRUE(runs.linear()) << what;
      std::printf("%s: dt = %.5f, by running %.5f\n", what.c_str(), found.truth.dt, runs.dt);
    }
}

INSTANTIATE_TEST_SUITE_P(Lattices, LatticeCase, testing::ValuesIn(lattices()),
                         [](const auto& test) { return test.param.name; });

}  // namespace
}  // namespace eigengrain::test
