// The true critical timestep and its estimates, in seconds and in units of matrix-free products.
#include "eigengrain/assembly/product.hpp"
#include "eigengrain/cycle/bounds.hpp"
#include "eigengrain/cycle/step_prover.hpp"
#include "eigengrain/timestep/estimates.hpp"
#include "eigengrain/timestep/truth.hpp"

#include "bench/measure.hpp"
#include "bench/packings.hpp"

#include <benchmark/benchmark.h>

#include <string>

namespace eigengrain::bench {
namespace {

/// One product of the eigensolver, ready to be called again and again.
class OneProduct {
 public:
  explicit OneProduct(const Packing& p)
      : product_(p.unknowns, p.elements, p.inverse_sqrt_mass()),
        x_(random_numbers(product_.size())),
        y_(x_.size()) {}
  void operator()() { product_.apply(x_, y_); }

 private:
  assembly::StiffnessProduct product_;
  std::vector<double> x_;
  std::vector<double> y_;
};

/// `call` by turns with products, on as many threads as the benchmark asks for.
template <class Call>
void in_products(benchmark::State& state, const Packing& p, const Call& call) {
  const Threads threads(state.range(1));
  OneProduct product(p);
  SideBySide times;
  for ([[maybe_unused]] auto _ : state) {
    const double unit = seconds_a_call(threads, [&] { product(); });
    const double seconds = threads.seconds(call);
    times.add(unit, seconds);
    state.SetIterationTime(seconds);
  }
  state.counters["in_products"] = times.second_over_first();
}

void critical_timestep(benchmark::State& state) {
  const Packing& p = packing(state.range(0));
  timestep::Truth truth;
  in_products(state, p, [&] { truth = timestep::critical_timestep(p); });
  state.counters["products"] = static_cast<double>(truth.products);
  state.counters["residual"] = truth.residual;
}
BENCHMARK(critical_timestep)->Apply(sizes_and_threads)->Iterations(3);

void diagonal_estimate(benchmark::State& state) {
  const Packing& p = packing(state.range(0));
  in_products(state, p, [&] { benchmark::DoNotOptimize(cycle::diagonal_estimate(p)); });
}
BENCHMARK(diagonal_estimate)->Apply(sizes_and_threads)->Iterations(5);

void block_bound(benchmark::State& state) {
  const Packing& p = packing(state.range(0));
  in_products(state, p, [&] { benchmark::DoNotOptimize(cycle::block_bound(p)); });
}
BENCHMARK(block_bound)->Apply(sizes_and_threads)->Iterations(5);

void scaled_block_bound(benchmark::State& state) {
  const Packing& p = packing(state.range(0));
  in_products(state, p, [&] { benchmark::DoNotOptimize(cycle::scaled_block_bound(p, 3)); });
}
BENCHMARK(scaled_block_bound)->Apply(sizes_and_threads)->Iterations(5);

/// A step of 0.95 of the truth proven from nothing, with what the prover sets up.
void proof(benchmark::State& state) {
  const Packing& p = packing(state.range(0));
  const double wished = 0.95 * timestep::critical_timestep(p).dt;
  double proven = 0;
  in_products(state, p, [&] { proven = cycle::StepProver(p).sharpen(wished); });
  state.counters["of_wished"] = proven / wished;
}
BENCHMARK(proof)->Apply(sizes_and_threads)->Iterations(5);

/// The same step proven again after 0.3% of the contacts opened, or closed again.
void proof_after_changes(benchmark::State& state) {
  Packing p(scene_of(state.range(0)));
  cycle::StepProver prover(p);
  const double step = prover.sharpen(0.95 * timestep::critical_timestep(p).dt);
  std::vector<std::int32_t> changed;
  std::vector<contact::ContactStiffness> stiffness;
  for (std::int64_t c = 0; c < p.contacts(); c += 333) {
    changed.push_back(static_cast<std::int32_t>(c));
    stiffness.push_back(p.elements[static_cast<std::size_t>(c)].stiffness);
  }
  bool closed = true;
  bool proven = true;
  in_products(state, p, [&] {
    closed = !closed;
    for (std::size_t k = 0; k < changed.size(); ++k)
      p.elements[static_cast<std::size_t>(changed[k])].stiffness =
          closed ? stiffness[k] : contact::ContactStiffness{};
    prover.update(changed);
    proven = prover.prove(step) && proven;
  });
  if (!proven) state.SkipWithError("the step could not be proven again");
}
BENCHMARK(proof_after_changes)->Apply(sizes_and_threads)->Iterations(20);

/// Every estimate by its name, on one thread.
void estimate(benchmark::State& state, const timestep::Estimator& estimator) {
  const Packing& p = packing(state.range(0));
  const Threads one;
  OneProduct product(p);
  SideBySide times;
  timestep::Answer answer;
  for ([[maybe_unused]] auto _ : state) {
    const double unit = seconds_a_call(one, [&] { product(); });
    const double seconds = one.seconds([&] { answer = estimator.find({p.model, p}); });
    times.add(unit, seconds);
    state.SetIterationTime(seconds);
  }
  if (!answer.left_out.empty()) state.SkipWithError(answer.left_out.c_str());
  state.counters["in_products"] = times.second_over_first();
}

[[maybe_unused]] const bool registered = [] {
  for (const timestep::Estimator& estimator : timestep::estimators())
    benchmark::RegisterBenchmark(("estimate/" + std::string(estimator.name)).c_str(),
                                 [&estimator](benchmark::State& state) { estimate(state, estimator); })
        ->Apply(sizes)
        ->Iterations(3);
  return true;
}();

}  // namespace
}  // namespace eigengrain::bench
