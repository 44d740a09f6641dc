// Infinite lattices: the spectrum, one estimate and the cycle against closed forms (docs/theory.md), for four
// ratios of stiffness, with rotation free and held.
#include "hard_cases/hard_case.hpp"

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>
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

/// Bloch's theorem: the largest eigenvalue of Σ 2 (1 - cos q·n)(n nᵀ + s (1 - n nᵀ)) over the three
/// directions of bonds, and over all waves that the box of the scene holds, 6 by 2√3 diameters. M and K are
/// among them; the infinite lattice has at most 7.5937 instead of 7.5088 (s = ⅔).
double hexagonal_held(double s) {
  const double root3 = std::sqrt(3.0);
  const std::array<Eigen::Vector2d, 3> bonds{{{1, 0}, {0.5, 0.5 * root3}, {-0.5, 0.5 * root3}}};
  double most = 0;
  for (int i = 0; i < 12; ++i)
    for (int j = 0; j < 4; ++j) {
      const Eigen::Vector2d q = 2 * std::numbers::pi * Eigen::Vector2d(i / 6.0, j / (2 * root3));
      Eigen::Matrix2d sum = Eigen::Matrix2d::Zero();
      for (const Eigen::Vector2d& n : bonds) {
        const Eigen::Matrix2d along = n * n.transpose();
        sum += 2 * (1 - std::cos(q.dot(n))) * (along + s * (Eigen::Matrix2d::Identity() - along));
      }
      most = std::max(most, Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(sum).eigenvalues()[1]);
    }
  return most;
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
        EXPECT_NEAR((*timestep::find_estimate(found, "diagonal")).ratio_to_true, std::sqrt(0.5), 1e-9)
            << what;
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
