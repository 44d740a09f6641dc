// The contact search. Nanoseconds a body and a pair must not grow with the number of bodies, but for caches.
#include "eigengrain/search/candidates.hpp"

#include "bench/measure.hpp"
#include "bench/packings.hpp"

#include <benchmark/benchmark.h>

namespace eigengrain::bench {
namespace {

void search(benchmark::State& state, const model::Bodies& bodies, const model::PeriodicCell& cell) {
  const Threads threads(state.range(1));
  std::size_t pairs = 0;
  time_each(state, threads,
            [&] { pairs = search::candidate_pairs(bodies.position, bodies.radius, cell).size(); });
  state.counters["pairs"] = static_cast<double>(pairs);
  state.counters["s_per_body"] = seconds_for_each(static_cast<double>(bodies.size()));
  state.counters["s_per_pair"] = seconds_for_each(static_cast<double>(pairs));
}

void search_packing(benchmark::State& state) {
  const assembly::Model& model = packing(state.range(0)).model;
  search(state, model.bodies, model.cell);
}
BENCHMARK(search_packing)->Apply(sizes_and_threads);

void search_cloud(benchmark::State& state, double ratio) {
  const Cloud balls = cloud(state.range(0), ratio);
  search(state, balls.bodies, balls.cell);
}
BENCHMARK_CAPTURE(search_cloud, radii_1_to_10, 10.0)->Apply(sizes_and_threads);
BENCHMARK_CAPTURE(search_cloud, radii_1_to_30, 30.0)->Apply(sizes_and_threads);

}  // namespace
}  // namespace eigengrain::bench
