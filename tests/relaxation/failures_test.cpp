// What relax says where it cannot find an equilibrium, and what it leaves.
#include "eigengrain/assembly/forces.hpp"
#include "eigengrain/base/error.hpp"
#include "eigengrain/cycle/cycle.hpp"
#include "eigengrain/relaxation/relax.hpp"

#include "packings.hpp"
#include "support/bonds.hpp"
#include "support/clumps.hpp"
#include "support/motion.hpp"

#include <gmock/gmock.h>

#include <limits>
#include <string>
#include <vector>

namespace eigengrain::test {
namespace {

using relaxation::RelaxOptions;
using relaxation::RelaxResult;
using testing::HasSubstr;

template <class Error>
std::string said(assembly::State& state, const RelaxOptions& options = {}) {
  try {
    relaxation::relax(state, options);
  } catch (const Error& error) {
    return error.what();
  }
  return "nothing";
}

TEST(RelaxFailures, NamesTheBallOfWhichSomethingIsNoNumber) {
  assembly::State state = cycle::start(packed());
  state.model.bodies.position[row_of(state, 17)].y() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(said<InputError>(state), HasSubstr("ball 17: its position is not a number"));
}

TEST(RelaxFailures, NamesLoadsThatNothingHolds) {
  SceneBuilder builder({.kn = 1e4, .tension = false});
  builder.ball({0, 0, 0}).ball({0, 0, 1.99}).gravity({0, 0, -10});
  assembly::State state = cycle::start(builder.scene());
  EXPECT_THAT(said<SolverError>(state), HasSubstr("neither a wall nor a body that is fixed"));
  // A body that is fixed along the load holds them; one that is fixed across it does not.
  builder.scene().bodies.fixed[0] = model::FixedComponents(0b000100);
  state = cycle::start(builder.scene());
  EXPECT_EQ(said<SolverError>(state, {.max_steps = 100}), "nothing");
  builder.scene().bodies.fixed[0] = model::FixedComponents(0b000011);
  state = cycle::start(builder.scene());
  EXPECT_THAT(said<SolverError>(state), HasSubstr("neither a wall"));
}

// Loads that cancel move nothing: two balls that are pressed together in the air.
TEST(RelaxFailures, LetsLoadsBalanceEachOther) {
  SceneBuilder builder({.kn = 1e4, .ks = 5e3, .tension = false});
  builder.ball({0, 0, 0}).loaded({0, 0, 3}).ball({0, 0, 1.9995}).loaded({0, 0, -3});
  assembly::State state = cycle::start(builder.scene());
  const RelaxResult result = relaxation::relax(state);
  EXPECT_TRUE(result.converged);
  const Vec3 apart = position_of(state, 1) - position_of(state, 0);
  EXPECT_NEAR(apart.norm(), 2 - 3 / 1e4, 1e-12);
}

TEST(RelaxFailures, CountsGroupsThatFloat) {
  SceneBuilder builder({.kn = 1e4, .tension = false});
  builder.plane({0, 0, 0}, {0, 0, 1}).gravity({0, 0, -10}).bonded(Cemented{}.rule());
  builder.ball({0, 0, 0.999});  // stands
  builder.ball({10, 0, 1e6})
      .ball({10, 0, 1e6 + 2})
      .ball({20, 0, 1e6});  // a pair that is bonded, and one, fall
  assembly::State state = cycle::start(builder.scene());
  const RelaxResult result = relaxation::relax(state, {.max_steps = 100});
  EXPECT_FALSE(result.converged);
  ASSERT_EQ(result.floating.size(), 2U);
  EXPECT_EQ(result.floating[0].bodies, 2);
  EXPECT_EQ(result.floating[1].bodies, 1);
  EXPECT_EQ(result.floating[1].first, 3);
}

// A ball between two that are held, which are nearer than it is wide: it is squeezed, and rests in
// the middle, which is an equilibrium though not a stable one.
TEST(RelaxFailures, BodiesThatAreHeldMaySqueezeOthers) {
  SceneBuilder builder({.kn = 1e4, .tension = false});
  builder.ball({0, 0, 0}, 1, 1, fix_all).ball({0, 0, 1.8}).ball({0, 0, 3.5}, 1, 1, fix_all);
  assembly::State state = cycle::start(builder.scene());
  EXPECT_TRUE(relaxation::relax(state).converged);
  EXPECT_NEAR(position_of(state, 1).z(), 1.75, 1e-9);
}

TEST(RelaxFailures, AnInterruptLeavesAStateThatIsGood) {
  for (const relaxation::Method method : {relaxation::Method::tracked, relaxation::Method::newton}) {
    assembly::State state = cycle::start(packed());
    state.model.gravity = Vec3(1, 0, -9.7);
    int asked = 0;
    RelaxOptions options;
    options.method = method;
    options.interrupted = [&] { return ++asked > 3; };
    const RelaxResult result = relaxation::relax(state, options);
    EXPECT_FALSE(result.converged);
    EXPECT_LT(asked, 100);
    for (const Vec3& x : state.model.bodies.position) EXPECT_TRUE(x.allFinite());
    // What the cycle sums four contacts at a time is what one at a time gives, but for ulps of places (0.2 m)
    // times k_n in each of up to twelve contacts.
    const double rounding = 12 * 1e5 * 0.2 * std::numeric_limits<double>::epsilon();
    const std::vector<Vec3> expected = assembly::contact_forces(state.model).force;
    for (std::size_t i = 0; i < expected.size(); ++i)
      EXPECT_LT((state.force[i] - expected[i]).norm(), rounding) << i;
    EXPECT_EQ(state.step, 0);
  }
}

}  // namespace
}  // namespace eigengrain::test
