// The matrix-free product beside the memory bandwidth of the same machine in the same minute.
#include "eigengrain/assembly/product.hpp"

#include "bench/measure.hpp"
#include "bench/packings.hpp"

#include <benchmark/benchmark.h>

namespace eigengrain::bench {
namespace {

/// a <- b + s c, as in STREAM, on vectors that are far larger than caches; 24 bytes an entry (32 where the
/// processor reads a before it writes it, which is not counted there either).
void triad(benchmark::State& state) {
  const Threads threads(state.range(0));
  constexpr std::int64_t n = 1 << 24;
  std::vector<double> a(n);
  const std::vector<double> b(n, 1.0);
  const std::vector<double> c(n, 2.0);
  time_each(state, threads, [&] {
    for_chunks(n, n / 64, [&](std::int64_t begin, std::int64_t end, std::int64_t) {
      for (std::int64_t i = begin; i < end; ++i) {
        const auto k = static_cast<std::size_t>(i);
        a[k] = b[k] + 3.0 * c[k];
      }
    });
    benchmark::ClobberMemory();
  });
  state.counters["bytes_per_s"] = each_second(24.0 * static_cast<double>(n));
}
BENCHMARK(triad)->ArgNames({"threads"})->Arg(1)->Arg(2)->UseManualTime()->Unit(benchmark::kMillisecond);

/// M^-½ K M^-½ x, as the eigensolver asks for it.
void product(benchmark::State& state) {
  const Packing& p = packing(state.range(0));
  const Threads threads(state.range(1));
  assembly::StiffnessProduct k(p.unknowns, p.elements, p.inverse_sqrt_mass());
  const std::vector<double> x = random_numbers(k.size());
  std::vector<double> y(x.size());
  time_each(state, threads, [&] { k.apply(x, y); });

  const auto contacts = static_cast<double>(p.contacts());
  const auto bytes = static_cast<double>(k.record_bytes());
  state.counters["contacts"] = contacts;
  state.counters["coordination"] = p.coordination();
  state.counters["bytes_per_contact"] = bytes / contacts;
  state.counters["s_per_contact"] = seconds_for_each(contacts);
  state.counters["bytes_per_s"] = each_second(bytes);
}
BENCHMARK(product)->Apply(sizes_and_threads);

}  // namespace
}  // namespace eigengrain::bench
