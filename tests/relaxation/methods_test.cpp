// The methods of relax, each alone.
#include "eigengrain/cycle/cycle.hpp"
#include "eigengrain/relaxation/relax.hpp"

#include "packings.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace eigengrain::test {
namespace {

using relaxation::Method;

/// A thousand balls whose gravity has tilted by ten degrees.
assembly::State tilted(const PackedBox& box = {}) {
  model::Scene scene = packed(box);
  const double angle = 10 * std::numbers::pi / 180;
  scene.gravity = scene.gravity.norm() * Vec3(std::sin(angle), 0, -std::cos(angle));
  return cycle::start(scene);
}

class EachMethod : public testing::TestWithParam<Method> {};

TEST_P(EachMethod, FindsAnEquilibrium) {
  assembly::State state = tilted();
  relaxation::RelaxOptions options;
  options.method = GetParam();
  options.tolerance = 1e-9;
  const relaxation::RelaxResult result = relaxation::relax(state, options);
  EXPECT_TRUE(result.converged) << result.end.mean << ' ' << result.end.moment_mean << ' '
                                << result.explicit_steps;
  EXPECT_LE(assembly::balance_of(state).mean, 1e-9);
  EXPECT_EQ(assembly::balance_of(state).unsupported, 0);
  // Seen again from outside: no mass, damping or step of the method is left in the state.
  EXPECT_TRUE(state.model.bodies.mass_factor.empty());
  EXPECT_EQ(state.model.local_damping, 0.7);
  EXPECT_FALSE(state.settings.mass_scaling);
  EXPECT_EQ(state.step, 0);
  EXPECT_FALSE(result.course.empty());
}

INSTANTIATE_TEST_SUITE_P(Relax, EachMethod,
                         testing::Values(Method::hybrid, Method::explicit_cycle, Method::tracked,
                                         Method::scaled, Method::fire),
                         [](const auto& method) { return std::string(relaxation::name_of(method.param)); });

}  // namespace
}  // namespace eigengrain::test
