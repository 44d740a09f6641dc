#pragma once

#include "eigengrain/assembly/local_damping.hpp"
#include "eigengrain/timestep/truth.hpp"

#include "support/clusters.hpp"
#include "support/dense.hpp"
#include "support/laws.hpp"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

/// Scenes with dashpots and local damping, alike or mixed.
namespace eigengrain::test {

inline timestep::Truth truth_of(const System& s, const timestep::TruthOptions& options = {}) {
  return timestep::critical_timestep(s, assembly::damping_of_unknowns(s.model, s.unknowns), options);
}

/// dense_limit() with the α that each body of a model has.
inline double dense_limit_of(const System& s) {
  std::vector<double> alpha;
  for (std::size_t i = 0; i < s.model.bodies.position.size(); ++i)
    alpha.push_back(assembly::damping_of(s.model, i));
  return dense_limit(s, alpha);
}

/// Linear springs that pull, with dashpots. All contacts alike, or, with `others`, those between balls of
/// the second material and those across with ratios of their own.
struct Dashpot {
  double normal = 0;
  double shear = 0;
};
inline SceneBuilder damped_scene(double ks, Dashpot beta, std::vector<Dashpot> others = {}) {
  const auto rule = [&](Dashpot b) {
    return values_of("linear", {{"kn", 1},
                                {"ks", ks},
                                {"friction", ks > 0 ? 0.5 : 0},
                                {"tension", 1},
                                {"beta_n", b.normal},
                                {"beta_s", b.shear}});
  };
  SceneBuilder builder;
  builder.scene().contacts = {{.law = "linear", .parameters = rule(beta)}};
  if (others.empty()) return builder;
  builder.scene().materials.push_back({"other", 1.0});
  builder.scene().contacts = {{.first = 0, .second = 0, .law = "linear", .parameters = rule(beta)},
                              {.first = 0, .second = 1, .law = "linear", .parameters = rule(others.at(0))},
                              {.first = 1, .second = 1, .law = "linear", .parameters = rule(others.at(1))}};
  return builder;
}

inline SceneBuilder& with_balls(SceneBuilder& builder, const PlacedBalls& places) {
  for (std::size_t i = 0; i < places.centres.size(); ++i)
    builder.ball(places.centres[i], places.radii[i], std::pow(places.radii[i], 3));
  return builder;
}

/// α and material of each ball for itself.
inline void mix(SceneBuilder& builder, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> uniform(0, 1);
  model::Bodies& bodies = builder.scene().bodies;
  bodies.damping.clear();
  for (std::size_t i = 0; i < bodies.position.size(); ++i) {
    bodies.damping.push_back(0.8 * uniform(random));
    if (builder.scene().materials.size() > 1) bodies.material[i] = uniform(random) < 0.5 ? 0 : 1;
  }
}

}  // namespace eigengrain::test
