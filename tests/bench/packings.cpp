#include "packings.hpp"

#include "eigengrain/assembly/stiffness.hpp"
#include "eigengrain/io/scene_reader.hpp"

#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <random>
#include <string>

namespace eigengrain::bench {
namespace {

/// Twice as long along z as along x and y: 10, 100 and 1,000 thousand are then close to whole numbers of
/// cells.
std::array<int, 3> lattice_cells(std::int64_t bodies) {
  const int n = static_cast<int>(std::lround(std::cbrt(static_cast<double>(bodies) / 8)));
  return {n, n, 2 * n};
}

model::Scene jittered_lattice(std::int64_t bodies) {
  constexpr double spacing = 2.0;  // of neighbours; twice the mean radius, so that one in two touches
  constexpr std::array<std::array<double, 3>, 4> sites{{{0, 0, 0}, {.5, .5, 0}, {.5, 0, .5}, {0, .5, .5}}};
  const double edge = spacing * std::numbers::sqrt2;
  const std::array<int, 3> cells = lattice_cells(bodies);

  model::Scene scene;
  scene.name = "jittered lattice";
  scene.materials.push_back({"grain", 2500.0});
  scene.contacts.push_back({.law = "linear", .parameters = {1e5, 5e4, 0.5, 0.0, 0.0, 0.0}});
  scene.cell =
      model::PeriodicCell::box(Vec3::Zero(), edge * Vec3(cells[0], cells[1], cells[2]), {true, true, true});

  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> jitter(-0.05, 0.05);
  std::uniform_real_distribution<double> radius(0.9, 1.1);
  model::Bodies& b = scene.bodies;
  for (int i = 0; i < cells[0]; ++i)
    for (int j = 0; j < cells[1]; ++j)
      for (int k = 0; k < cells[2]; ++k)
        for (const std::array<double, 3>& site : sites) {
          const Vec3 shift(jitter(random), jitter(random), jitter(random));
          b.identity.push_back(b.size());
          b.position.push_back(
              scene.cell.wrapped(edge * Vec3(i + site[0], j + site[1], k + site[2]) + shift));
          b.radius.push_back(radius(random));
          b.mass.push_back(model::sphere_mass(b.radius.back(), 2500.0));
          b.inertia.push_back(model::sphere_inertia(b.radius.back(), b.mass.back()));
        }
  b.material.assign(b.position.size(), 0);
  b.fixed.assign(b.position.size(), {});
  return scene;
}

}  // namespace

model::Scene scene_of(std::int64_t bodies) {
  const std::string settled = EIGENGRAIN_EXAMPLES "/scenes/packing_";
  if (bodies == 10'000) return io::read_scene(settled + "10k.yaml");
  if (bodies == 100'000) return io::read_scene(settled + "100k.yaml");
  return jittered_lattice(bodies);
}

namespace {

constexpr std::array<std::int64_t, 4> all_sizes{1'000, 10'000, 100'000, 1'000'000};

}  // namespace

Packing::Packing(const model::Scene& scene) : WithModel{assembly::build_model(scene)}, LinearSystem(model) {}

double Packing::coordination() const {
  std::int64_t ends = 0;
  for (const contact::ContactElement& e : elements) ends += e.b == contact::no_body ? 1 : 2;
  return static_cast<double>(ends) / static_cast<double>(model.bodies.size());
}

const Packing& packing(std::int64_t bodies) {
  static std::map<std::int64_t, Packing> made;
  const auto found = made.find(bodies);
  return found != made.end() ? found->second : made.try_emplace(bodies, scene_of(bodies)).first->second;
}

Cloud cloud(std::int64_t bodies, double ratio) {
  constexpr double power = -3.5;
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> uniform(0, 1);
  Cloud result;
  model::Bodies& b = result.bodies;
  double solid = 0;
  for (std::int64_t i = 0; i < bodies; ++i) {
    // The inverse of the cumulative distribution between 1 and ratio.
    const double tail = std::pow(ratio, power + 1);
    const double radius = std::pow(1 + uniform(random) * (tail - 1), 1 / (power + 1));
    b.identity.push_back(i);
    b.radius.push_back(radius);
    b.mass.push_back(model::sphere_mass(radius, 1.0));
    solid += b.mass.back();
  }
  b.inertia = b.mass;
  b.material.assign(b.radius.size(), 0);
  b.fixed.assign(b.radius.size(), {});
  const double edge = std::cbrt(solid / 0.6);
  result.cell = model::PeriodicCell::box(Vec3::Zero(), Vec3::Constant(edge), {true, true, true});
  for (std::int64_t i = 0; i < bodies; ++i)
    b.position.push_back(edge * Vec3(uniform(random), uniform(random), uniform(random)));
  model::sort_along_curve(b);
  return result;
}

void sizes_and_threads(benchmark::internal::Benchmark* benchmark) {
  benchmark->ArgNames({"bodies", "threads"})->UseManualTime()->Unit(benchmark::kMillisecond);
  for (const std::int64_t size : all_sizes)
    for (const std::int64_t threads : {1, 2}) benchmark->Args({size, threads});
}

void sizes(benchmark::internal::Benchmark* benchmark) {
  benchmark->ArgNames({"bodies"})->UseManualTime()->Unit(benchmark::kMillisecond);
  for (const std::int64_t size : all_sizes) benchmark->Args({size});
}

}  // namespace eigengrain::bench
