#include "packings.hpp"

#include "eigengrain/assembly/stiffness.hpp"
#include "eigengrain/generate/jittered_lattice.hpp"
#include "eigengrain/io/scene_reader.hpp"

#include <array>
#include <cmath>
#include <map>
#include <random>
#include <string>

namespace eigengrain::bench {
namespace {

model::Scene jittered_lattice(std::int64_t bodies) {
  generate::Random random(1);
  const generate::PeriodicBalls made = generate::jittered_lattice(bodies, random);
  model::Scene scene;
  scene.name = "jittered lattice";
  scene.materials.push_back({"grain", 2500.0});
  scene.contacts.push_back({.law = "linear", .parameters = {1e5, 5e4, 0.5, 0.0, 0.0, 0.0}});
  scene.cell = made.region.cell();
  model::Bodies& b = scene.bodies;
  b.position = made.balls.position;
  b.radius = made.balls.radius;
  for (const double radius : b.radius) {
    b.identity.push_back(static_cast<std::int64_t>(b.identity.size()));
    b.mass.push_back(model::sphere_mass(radius, 2500.0));
    b.inertia.push_back(model::sphere_inertia(radius, b.mass.back()));
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
