#include "cost_by_size.hpp"

#include "eigengrain/assembly/model.hpp"
#include "eigengrain/base/timer.hpp"
#include "eigengrain/generate/jittered_lattice.hpp"
#include "eigengrain/timestep/comparison.hpp"

#include "compared_scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>

namespace eigengrain::app {
namespace {

constexpr double density = 2500;  // kg/m3

model::Scene packing_of(std::int64_t balls) {
  generate::Random random(1);
  const generate::PeriodicBalls made = generate::jittered_lattice(balls, random);
  model::Scene scene;
  scene.name = fmt::format("{} balls", made.balls.position.size());
  scene.materials.push_back({.name = "grain", .density = density});
  // kn, ks in N/m, friction: as in the packings of examples/
  scene.contacts.push_back({.law = "linear", .parameters = {1e5, 5e4, 0.5}});
  scene.cell = made.region.cell();
  model::Bodies& bodies = scene.bodies;
  bodies.position = made.balls.position;
  bodies.radius = made.balls.radius;
  for (const double radius : bodies.radius) {
    bodies.identity.push_back(static_cast<std::int64_t>(bodies.identity.size()));
    bodies.mass.push_back(model::sphere_mass(radius, density));
    bodies.inertia.push_back(model::sphere_inertia(radius, bodies.mass.back()));
  }
  bodies.material.assign(bodies.radius.size(), 0);
  bodies.fixed.assign(bodies.radius.size(), {});
  return scene;
}

/// Of the line that fits ln(seconds) over ln(bodies) best.
double slope_of(std::span<const CostOfSize> sizes, const std::string& name) {
  const auto n = static_cast<double>(sizes.size());
  double mean_x = 0;
  double mean_y = 0;
  for (const CostOfSize& size : sizes) {
    mean_x += std::log(static_cast<double>(size.bodies)) / n;
    mean_y += std::log(seconds_of(size, name)) / n;
  }
  double xy = 0;
  double xx = 0;
  for (const CostOfSize& size : sizes) {
    const double x = std::log(static_cast<double>(size.bodies)) - mean_x;
    xy += x * (std::log(seconds_of(size, name)) - mean_y);
    xx += x * x;
  }
  return xy / xx;
}

}  // namespace

double seconds_of(const CostOfSize& cost, const std::string& name) {
  if (name == name_of_product) return cost.product_seconds;
  if (name == name_of_truth) return cost.truth_seconds;
  const auto found = std::find_if(cost.estimates.begin(), cost.estimates.end(),
                                  [&](const CostOfSize::Cost& other) { return other.name == name; });
  return found != cost.estimates.end() ? found->seconds : std::numeric_limits<double>::quiet_NaN();
}

std::vector<CostOfSize> costs_by_size(const std::vector<std::int64_t>& sizes) {
  std::vector<std::int64_t> sorted = sizes;
  std::sort(sorted.begin(), sorted.end());
  std::vector<CostOfSize> costs;
  for (const std::int64_t size : sorted) {
    const Stopwatch watch;
    const model::Scene scene = packing_of(size);
    const assembly::Model model = assembly::build_model(scene);
    const assembly::LinearSystem system(model);
    timestep::Comparison found = timestep::compare(model, {}, scene.materials);
    measure_again({model, system, scene.materials}, found);
    CostOfSize& cost = costs.emplace_back();
    cost.bodies = found.bodies;
    cost.contacts = found.contacts;
    cost.product_seconds = seconds_of_product(system);
    cost.truth_seconds = found.truth.seconds;
    for (const timestep::Estimate& estimate : found.estimates)
      cost.estimates.push_back({estimate.name, estimate.seconds});
    fmt::print(stderr, "{} balls: {:.2g} s\n", cost.bodies, watch.seconds());
  }
  return costs;
}

std::span<const CostOfSize> sizes_of_growth(const std::vector<CostOfSize>& costs) {
  constexpr std::int64_t large = 1000;  // below it calls count, not bodies
  const auto first =
      std::find_if(costs.begin(), costs.end(), [](const CostOfSize& c) { return c.bodies >= large; });
  return costs.end() - first >= 2 ? std::span(first, costs.end()) : std::span(costs);
}

std::vector<Growth> growth_of(const std::vector<CostOfSize>& costs) {
  std::vector<Growth> result;
  if (costs.size() < 2) return result;
  const std::span<const CostOfSize> sizes = sizes_of_growth(costs);
  std::vector<std::string> names{name_of_product, name_of_truth};
  for (const CostOfSize::Cost& mine : costs.back().estimates) names.push_back(mine.name);
  for (const std::string& name : names) {
    const double exponent = slope_of(sizes, name);
    if (std::isfinite(exponent)) result.push_back({name, exponent});
  }
  return result;
}

}  // namespace eigengrain::app
