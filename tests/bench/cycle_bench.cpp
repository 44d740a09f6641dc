// The explicit cycle: ball steps a second, and what a step and a list cost in products with K.
#include "eigengrain/cycle/cycle.hpp"
#include "eigengrain/cycle/policy.hpp"

#include "measure.hpp"
#include "packings.hpp"

namespace eigengrain::bench {
namespace {

/// Steps at a fixed dt after some that bring the caches and the lists into order.
void cycle_steps(benchmark::State& state, double friction) {
  const Threads threads(state.range(1));
  model::Scene scene = scene_of(state.range(0));
  for (model::ContactRule& rule : scene.contacts) rule.parameters[2] = friction;
  cycle::Cycle cycle(cycle::start(scene), cycle::policy_of(scene));
  cycle.run(3);
  time_each(state, threads, [&] { cycle.step(); });
  const auto balls = static_cast<double>(cycle.state().model.bodies.size());
  state.counters["ball_steps"] = each_second(balls);
  state.counters["near_pairs_a_ball"] = static_cast<double>(cycle.state().model.contacts.size()) / balls;
}

void cycle_frictional(benchmark::State& state) {
  cycle_steps(state, 0.5);
}
BENCHMARK(cycle_frictional)->Apply(sizes_and_threads);

/// Neither rotations nor history.
void cycle_frictionless(benchmark::State& state) {
  cycle_steps(state, 0.0);
}
BENCHMARK(cycle_frictionless)->Apply(sizes_and_threads);

}  // namespace
}  // namespace eigengrain::bench
