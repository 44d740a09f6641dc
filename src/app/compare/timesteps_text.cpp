#include "../text.hpp"
#include "standing.hpp"
#include "timesteps_report.hpp"
#include "verdict.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

namespace eigengrain::app {
namespace {

using timestep::Estimate;

void print_scene(const ComparedScene& scene) {
  const timestep::Comparison& c = scene.comparison;
  fmt::print("{}: {}, {}, {}\n", scene.file, counted(c.bodies, "ball", "balls"),
             counted(c.contacts, "acting contact", "acting contacts"),
             counted(c.unknowns, "unknown", "unknowns"));
  fmt::print("one product with K takes {:.3g} s; costs are in products that take the same time\n\n",
             scene.product_seconds);
  fmt::print("{:<26} {:>14} {:>9} {:>10} {:>9}  {}\n", "critical timestep", "dt [s]", "of true", "seconds",
             "cost", "");
  fmt::print("{:<26} {:>14.8e} {:>9.4f} {:>10.2g} {:>9.3g}  residual {:.1e}\n", "true", c.truth.dt, 1.0,
             c.truth.seconds, c.truth.seconds / scene.product_seconds, c.truth.residual);
  std::vector<Estimate> sorted = c.estimates;
  std::stable_sort(sorted.begin(), sorted.end(),
                   [](const Estimate& a, const Estimate& b) { return a.ratio_to_true > b.ratio_to_true; });
  for (const Estimate& e : sorted)
    fmt::print("{:<26} {:>14.8e} {:>9.4f} {:>10.2g} {:>9.3g}  {}\n", e.name, e.dt, e.ratio_to_true, e.seconds,
               equivalent_products(scene, e), text_of(verdict_on(e)));
  for (const timestep::LeftOut& none : c.left_out) fmt::print("{:<26} none: {}\n", none.name, none.reason);
}

void print_standings(const std::vector<ComparedScene>& scenes) {
  fmt::print("{:<26} {:>7} {:>7}  {:>9} {:>9} {:>9} {:>9}  {}\n", "ratio to the true step", "scenes",
             "unsafe", "smallest", "median", "largest", "cost", "largest in");
  for (const Standing& s : standings_of(scenes))
    fmt::print("{:<26} {:>7} {:>7}  {:>9.4f} {:>9.4f} {:>9.4f} {:>9.3g}  {}\n", s.name, s.scenes,
               s.unsafe == 0 ? std::string("-") : std::to_string(s.unsafe), s.smallest, s.median, s.largest,
               s.median_products, s.largest_in);
  fmt::print("\ncost: median, in products with K that take the same time\n");
}

void print_sizes(const std::vector<CostOfSize>& sizes) {
  fmt::print("\n{:<26}", "seconds, by balls");
  for (const CostOfSize& size : sizes) fmt::print(" {:>10}", grouped(size.bodies));
  fmt::print(" {:>9}\n", "exponent");
  const auto cell = [](double value) { fmt::print(" {:>10.2g}", value); };
  for (const Growth& growth : growth_of(sizes)) {
    fmt::print("{:<26}", growth.name);
    for (const CostOfSize& size : sizes) cell(seconds_of(size, growth.name));
    fmt::print(" {:>9.2f}\n", growth.exponent);
  }
}

}  // namespace

void print(const TimestepsReport& report) {
  const auto done = std::count_if(report.scenes.begin(), report.scenes.end(),
                                  [](const ComparedScene& scene) { return scene.skipped.empty(); });
  if (done > 1) {
    print_standings(report.scenes);
  } else {
    for (const ComparedScene& scene : report.scenes)
      if (scene.skipped.empty()) print_scene(scene);
  }
  for (const ComparedScene& scene : report.scenes)
    if (!scene.skipped.empty()) fmt::print("{}: left out: {}\n", scene.name, scene.skipped);
  if (!report.sizes.empty()) print_sizes(report.sizes);
}

}  // namespace eigengrain::app
