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

std::vector<Growth> growth_of(const std::vector<CostOfSize>& costs) {
  std::vector<Growth> result;
  if (costs.size() < 2) return result;
  const CostOfSize& large = costs[costs.size() - 1];
  const CostOfSize& small = costs[costs.size() - 2];
  const double decades = std::log(static_cast<double>(large.bodies) / static_cast<double>(small.bodies));
  if (!(decades > 0)) return result;
  std::vector<std::string> names{name_of_product, name_of_truth};
  for (const CostOfSize::Cost& mine : large.estimates) names.push_back(mine.name);
  for (const std::string& name : names) {
    const double exponent = std::log(seconds_of(large, name) / seconds_of(small, name)) / decades;
    if (std::isfinite(exponent)) result.push_back({name, exponent});
  }
  return result;
}

}  // namespace eigengrain::app
