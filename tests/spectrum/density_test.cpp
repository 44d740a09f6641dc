// The density of states by the kernel polynomial method against the whole spectrum.
#include "eigengrain/spectrum/density.hpp"

#include "eigengrain/base/error.hpp"
#include "eigengrain/base/parallel.hpp"
#include "eigengrain/cycle/bounds.hpp"
#include "eigengrain/spectrum/modes.hpp"

#include "spectrum/packings.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <numeric>

namespace eigengrain::test {
namespace {

using spectrum::Density;
using spectrum::density_of_states;

TEST(DensityOfStates, AModeIsCountedOnceWhereverItIs) {
  const std::vector<double> edge{0, 0.25, 0.5, 0.75, 1};
  for (const double omega : {0.0, 0.1, 0.4, 0.75, 0.99, 1.0}) {
    const std::vector<double> parts = spectrum::smeared(omega * omega, 1, 400, edge);
    EXPECT_NEAR(std::accumulate(parts.begin(), parts.end(), 0.0), 1, 1e-13);
    for (const double part : parts) EXPECT_GE(part, -1e-13);  // Jackson's kernel is positive
    if (omega == 0.4) EXPECT_NEAR(parts[1], 1, 1e-4);
    if (omega == 0.75) EXPECT_NEAR(parts[2], 0.5, 0.01);  // on an edge
    if (omega == 0.0) EXPECT_NEAR(parts[0], 1, 1e-4);
  }
}

// What the random vectors err by: the same smearing of the known spectrum is what they would give without.
TEST(DensityOfStates, ErrsByWhatItSays) {
  const System system = pressed_packing("60 mm");
  const Density density = density_of_states(system, {.moments = 128, .vectors = 24, .bins = 16, .seed = 3});
  const double step = cycle::scaled_block_bound(system, 10);
  const double bound = 4 / (step * step);
  ASSERT_NEAR(density.edge.back(), std::sqrt(bound), 1e-9 * std::sqrt(bound));
  std::vector<double> exact(16, 0.0);
  std::vector<double> counted(16, 0.0);
  for (const double lambda : spectrum::all_modes(system, false).lambda) {
    const std::vector<double> parts = spectrum::smeared(lambda, bound, 128, density.edge);
    for (std::size_t k = 0; k < 16; ++k) exact[k] += parts[k];
    const auto bin = static_cast<std::size_t>(16 * std::sqrt(std::max(lambda, 0.0) / bound));
    counted[std::min<std::size_t>(bin, 15)] += 1;
  }
  int beyond_two = 0;
  for (std::size_t k = 0; k < 16; ++k) {
    std::printf("%8.2f +- %5.2f  smeared %8.2f  counted %5.0f\n", density.count[k], density.error[k],
                exact[k], counted[k]);
    EXPECT_NEAR(density.count[k], exact[k], 4 * density.error[k] + 1e-9) << k;
    if (std::abs(density.count[k] - counted[k]) > 2 * density.error[k] + 0.5) ++beyond_two;
  }
  // One in twenty of normal errors is beyond two standard errors.
  EXPECT_LE(beyond_two, 2);
  EXPECT_NEAR(std::accumulate(density.count.begin(), density.count.end(), 0.0), density.modes,
              1e-9 * density.modes);
  EXPECT_EQ(density.products, 24 * 64);
}

TEST(DensityOfStates, IsTheSameOnAnyNumberOfThreads) {
  const System system = pressed_packing();
  const int before = threads();
  set_threads(1);
  const Density one = density_of_states(system, {.moments = 64, .vectors = 2, .bins = 8});
  set_threads(3);
  const Density three = density_of_states(system, {.moments = 64, .vectors = 2, .bins = 8});
  set_threads(before);
  EXPECT_EQ(one.count, three.count);
}

TEST(DensityOfStates, EndsWhereAsked) {
  const System system = pressed_packing();
  int products = 0;
  const Density density = density_of_states(
      system, {.moments = 64, .vectors = 5, .bins = 8, .interrupted = [&] { return ++products > 100; }});
  EXPECT_FALSE(density.complete);
  EXPECT_EQ(density.count.size(), 8U);  // of the three vectors that were done
}

TEST(DensityOfStates, RefusesNumbersThatMakeNoSense) {
  const System system = pressed_packing();
  EXPECT_THROW(density_of_states(system, {.moments = 4}), InputError);
  EXPECT_THROW(density_of_states(system, {.vectors = 1}), InputError);
  EXPECT_THROW(density_of_states(system, {.moments = 64, .bins = 65}), InputError);
}

}  // namespace
}  // namespace eigengrain::test
