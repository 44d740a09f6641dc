// What estimates claim of themselves, against the dense spectrum of random clusters.
//
// EIGENGRAIN_CASES=100000 build/release/bin/test_timestep --gtest_filter='EstimateClaims.*'
#include "support/estimates.hpp"
#include "support/random_bodies.hpp"

#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <map>
#include <string>

namespace eigengrain::test {
namespace {

int cases() {
  const char* wanted = std::getenv("EIGENGRAIN_CASES");
  return wanted == nullptr ? 4000 : std::atoi(wanted);
}

/// Ratios to the truth that an estimate has had.
struct Seen {
  double largest = 0;
  double sum = 0;
  int unsafe = 0;
  int count = 0;
};

TEST(EstimateClaims, HoldInRandomClustersOfBallsAndClumps) {
  RandomBodies bodies(2026);
  std::map<std::string, Seen> seen;
  int scenes = 0;
  int with_clumps = 0;
  int with_moments = 0;
  int with_own_images = 0;
  while (scenes < cases()) {
    const SceneBuilder scene = bodies.next();
    const System system(scene);
    if (system.unknowns.free_components().empty()) continue;
    const Eigen::VectorXd spectrum = system.spectrum();
    const double lambda = spectrum[spectrum.size() - 1];
    if (lambda < 1e-12) continue;  // contacts act along fixed components only
    ++scenes;
    with_clumps += system.unknowns.has_axes() ? 1 : 0;
    for (const contact::ContactElement& e : system.elements)
      if (e.stiffness.bending > 0) {
        ++with_moments;
        break;
      }
    for (const contact::ContactElement& e : system.elements)
      if (e.a == e.b) {
        ++with_own_images;
        break;
      }
    const double truth = 2 / std::sqrt(lambda);
    for (const timestep::Estimator& estimator : timestep::estimators()) {
      const timestep::Answer answer = answer_of(estimator, system);
      if (!answer.left_out.empty()) continue;
      // The dense eigenvalue itself errs by some 1e-14 of the largest.
      const bool safe = answer.dt <= truth * (1 + 1e-12);
      // Of five probable bounds in a hundred thousand scenes half a one may fail, and the proofs are not
      // sharp.
      if (estimator.claim != timestep::Claim::none) {
        ASSERT_TRUE(safe) << estimator.name << " in scene " << scenes << ": " << answer.dt / truth;
      }
      Seen& all = seen[std::string(estimator.name)];
      all.largest = std::max(all.largest, answer.dt / truth);
      all.sum += answer.dt / truth;
      all.unsafe += answer.dt <= truth * (1 + 1e-9) ? 0 : 1;
      ++all.count;
    }
  }
  std::printf("%d scenes, %d with clumps, %d with bonds, %d with bodies that touch themselves\n", scenes,
              with_clumps, with_moments, with_own_images);
  std::printf("%-24s %9s %9s %9s\n", "estimate", "mean", "largest", "unsafe");
  for (const timestep::Estimator& estimator : timestep::estimators()) {
    const Seen& all = seen[std::string(estimator.name)];
    if (all.count > 0)
      std::printf("%-24s %9.4f %9.4f %8.2f%%\n", std::string(estimator.name).c_str(), all.sum / all.count,
                  all.largest, 100.0 * all.unsafe / all.count);
  }
  // The clusters are what they are meant to be.
  EXPECT_GT(with_clumps, scenes / 4);
  EXPECT_GT(with_moments, scenes / 10);
  EXPECT_GT(with_own_images, scenes / 50);
  EXPECT_GT(seen["yade-global-stiffness"].largest, 1.2);
}

}  // namespace
}  // namespace eigengrain::test
