// Dashpots from none to twice critical on a face-centred lattice: the limit of the cycle in closed form, and
// PFC3D's rule for it.
#include "hard_cases/hard_case.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

namespace eigengrain::test {
namespace {

/// sqrt(1 + β²) - β: by how much dashpots shorten the limit of one mode.
double shortened_by(double beta) {
  return std::sqrt(1 + beta * beta) - beta;
}

// One contact has c = 2β√(½ m k_n), so C = √(2m/k_n) β K is proportional to K, and the top mode, ω² = 8
// k_n/m, has ξ = ½ ω √(2m/k_n) β = 2β: the limit is (2/ω) F(2β). PFC3D's eq. 1.35 takes k_n/F(β)² of each
// contact.
TEST(Dashpots, OfALatticeActTogetherAndRule135DoesNotKnow) {
  double before = 0;
  for (const double beta : {0.0, 0.1, 0.5, 1.0, 2.0}) {
    const std::vector<std::string> overrides{fmt::format("contacts.0.beta_n={}", beta)};
    const assembly::State state = start_of("overdamped_lattice", overrides);
    const timestep::Comparison found = timestep::compare(state.model);
    const double limit = std::sqrt(0.5) * shortened_by(2 * beta);
    EXPECT_NEAR(found.truth.dt, std::sqrt(0.5), 1e-9);
    // A bound that is sharp here, as all blocks are alike; it is refined four times.
    EXPECT_NEAR(found.truth.limit / limit, 1, 1e-6) << beta;
    const double rule = (*timestep::find_estimate(found, "diagonal")).dt / limit;
    EXPECT_NEAR(rule, std::sqrt(0.5) * shortened_by(beta) / shortened_by(2 * beta), 1e-6) << beta;
    EXPECT_GT(rule, before);
    before = rule;
    const timestep::EmpiricalLimit runs = timestep::empirical_limit(state, found.truth);
    EXPECT_NEAR(runs.dt / limit, 1, 3e-4) << beta;
    EXPECT_TRUE(runs.linear());
    std::printf("beta %.1f: limit %.6f, by running %.6f of it, rule 1.35 %.4f of it\n", beta, limit,
                runs.dt / limit, rule);
  }
  EXPECT_GT(0.8 * before, 1.08);  // at beta = 2 the safety factor does not save it
}

}  // namespace
}  // namespace eigengrain::test
