#pragma once

#include "eigengrain/assembly/linear_system.hpp"
#include "eigengrain/assembly/model.hpp"

#include <benchmark/benchmark.h>

#include <cstdint>
#include <vector>

/// What the benchmarks work on.
namespace eigengrain::bench {

struct WithModel {
  assembly::Model model;
};

/// A dense packing, brought to life, and its linear system.
struct Packing : WithModel, assembly::LinearSystem {
  explicit Packing(const model::Scene& scene);

  /// Acting contacts a body has on average; one with a wall counts for one body.
  double coordination() const;
  std::int64_t contacts() const { return static_cast<std::int64_t>(elements.size()); }
};

/// Sliding linear contacts, radii within 10%: every body has rotations. Made once, then kept.
///
/// 10,000 and 100,000 bodies are the settled packings of examples/; other numbers are a synthetic stand-in: a
/// periodic face-centred lattice with jittered centres, of such a density that half of the 12 neighbours
/// touch, as in a settled packing.
const Packing& packing(std::int64_t bodies);

/// The scene of that packing.
model::Scene scene_of(std::int64_t bodies);

/// Balls thrown at random into a periodic cube, with a solid fraction of 0.6 and radii from 1 to `ratio`
/// that are distributed as the power -3.5 of the radius. They overlap more than grains do; that is of no
/// matter to a search.
struct Cloud {
  model::Bodies bodies;  ///< along a space-filling curve, as in a model
  model::PeriodicCell cell;
};
Cloud cloud(std::int64_t bodies, double ratio);

/// Sizes and numbers of threads, as arguments "bodies" and "threads". Time is what the benchmark says.
void sizes_and_threads(benchmark::internal::Benchmark* benchmark);
/// Sizes, on one thread.
void sizes(benchmark::internal::Benchmark* benchmark);

}  // namespace eigengrain::bench
