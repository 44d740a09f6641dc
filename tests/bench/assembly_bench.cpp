// From a model to what stands for K without a matrix.
#include "eigengrain/assembly/product.hpp"
#include "eigengrain/assembly/stiffness.hpp"

#include "bench/measure.hpp"
#include "bench/packings.hpp"

#include <benchmark/benchmark.h>

namespace eigengrain::bench {
namespace {

void describe(benchmark::State& state, const Packing& p) {
  state.counters["contacts"] = static_cast<double>(p.contacts());
  state.counters["coordination"] = p.coordination();
  state.counters["s_per_contact"] = seconds_for_each(static_cast<double>(p.contacts()));
}

void contact_elements(benchmark::State& state) {
  const Packing& p = packing(state.range(0));
  time_each(state, Threads(), [&] { benchmark::DoNotOptimize(assembly::contact_elements(p.model).data()); });
  describe(state, p);
}
BENCHMARK(contact_elements)->Apply(sizes);

void product_construction(benchmark::State& state) {
  const Packing& p = packing(state.range(0));
  const Threads threads(state.range(1));
  time_each(state, threads, [&] {
    const assembly::StiffnessProduct product(p.unknowns, p.elements);
    benchmark::DoNotOptimize(product.size());
  });
  describe(state, p);
}
BENCHMARK(product_construction)->Apply(sizes_and_threads);

}  // namespace
}  // namespace eigengrain::bench
