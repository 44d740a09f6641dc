#pragma once

#include "support/bonds.hpp"
#include "support/clumps.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

/// Random clusters of balls and clumps with all that makes a timestep hard to estimate.
namespace eigengrain::test {

class RandomBodies {
 public:
  explicit RandomBodies(std::uint64_t seed) : random_(seed) {}

  /// 2 to 8 bodies: sizes up to 100:1, clumps with given inertia, stiffnesses up to 10⁶:1 and k_s up to 2
  /// k_n; some with walls, with fixed bodies or components, with bonds that carry moments, or in a cell so
  /// small that bodies touch several images and themselves.
  SceneBuilder next() {
    const int bodies = 2 + static_cast<int>(random_() % 7);
    const double spread = std::pow(10.0, chance(0.3) ? 2 * uniform() : uniform());
    const bool clumps = chance(0.5);
    const bool held = chance(0.3);
    SceneBuilder builder(springs(1));
    stiffnesses(builder);
    std::vector<Vec3> centre;
    std::vector<double> radius;
    for (int body = 0; body < bodies; ++body) {
      const double size = std::pow(spread, uniform());
      Vec3 at = Vec3::Zero();
      if (body > 0) {
        const auto host = static_cast<std::size_t>(random_() % centre.size());
        const double overlap = 0.05 * uniform() * std::min(size, radius[host]);
        at = centre[host] + (radius[host] + size - overlap) * random_vector(random_).normalized();
      }
      const double mass = size * size * size * std::pow(10.0, chance(0.2) ? 2 * uniform() - 1 : 0);
      // Balls come before all clumps.
      if (clumps && body >= bodies / 2)
        add_clump(builder, at, size, mass, held, centre, radius);
      else
        add_ball(builder, at, size, mass, held, centre, radius);
    }
    if (chance(0.3)) builder.plane({0, 0, -0.9}, {0, 0, 1});
    if (chance(0.2)) builder.plane({0.9, 0, 0}, {-1, 0.3, 0.2});
    if (bodies <= 4 && chance(0.4))
      builder.periodic(
          Vec3::Constant(*std::max_element(radius.begin(), radius.end()) * (1.4 + 2 * uniform())));
    return builder;
  }

 private:
  double uniform() { return std::uniform_real_distribution<double>(0, 1)(random_); }
  bool chance(double p) { return uniform() < p; }

  Springs springs(double kn) { return {.kn = kn, .ks = chance(0.3) ? 0.0 : 2 * kn * uniform()}; }

  /// Two materials, three rules of their own, of which some have bonds.
  void stiffnesses(SceneBuilder& builder) {
    model::Scene& scene = builder.scene();
    scene.materials.push_back({"other", 1.0});
    const double contrast = chance(0.4) ? std::pow(10.0, 6 * uniform()) : 1.0;
    const model::ContactRule first = scene.contacts.front();
    scene.contacts.clear();
    for (const auto& [a, b] : {std::array{0, 0}, {0, 1}, {1, 1}}) {
      const Springs k = springs(a == b ? 1.0 : contrast);
      model::ContactRule rule = first;
      rule.first = a;
      rule.second = b;
      rule.parameters[0] = k.kn;
      rule.parameters[1] = k.ks;
      rule.parameters[2] = k.ks > 0 ? 0.5 : 0.0;
      if (chance(0.25))
        rule.bond = Cemented{.kn = std::pow(10.0, 4 * uniform() - 2), .ks = uniform(), .gap = 0.01}.rule();
      scene.contacts.push_back(rule);
    }
  }

  std::int32_t material() { return chance(0.3) ? 1 : 0; }

  void add_ball(SceneBuilder& builder, const Vec3& at, double size, double mass, bool held,
                std::vector<Vec3>& centre, std::vector<double>& radius) {
    model::FixedComponents fixed;
    if (held && chance(0.3))
      fixed = chance(0.5) ? fix_all : model::FixedComponents(static_cast<std::uint8_t>(random_() % 64));
    builder.ball(at, size, mass, fixed);
    builder.scene().bodies.material.back() = material();
    centre.push_back(at);
    radius.push_back(size);
  }

  /// A rod, a triangle or a tetrahedron of balls with any inertia that a body can have.
  void add_clump(SceneBuilder& builder, const Vec3& at, double size, double mass, bool held,
                 std::vector<Vec3>& centre, std::vector<double>& radius) {
    const int balls = 2 + static_cast<int>(random_() % 3);
    const double arm = size * (0.3 + 3 * uniform());
    std::vector<Vec3> place;
    for (int k = 0; k < balls; ++k) place.emplace_back(arm * random_vector(random_).normalized());
    const Vec3 part(0.01 + uniform(), 0.01 + uniform(), 0.01 + uniform());  // ∫x², ∫y², ∫z²
    const Vec3 inertia =
        mass * arm * arm * 0.3 * Vec3(part[1] + part[2], part[2] + part[0], part[0] + part[1]);
    const Quat orientation = random_orientation(random_);
    // Its first ball is where it was asked for.
    model::ClumpStart start{.position = at - orientation * place[0], .orientation = orientation};
    start.material = material();
    if (held && chance(0.3)) start.fixed = chance(0.5) ? fix_all : fix_rotations;
    builder.clump(given_shape(place, std::vector<double>(place.size(), size), mass, inertia), start);
    for (const Vec3& p : place) {
      centre.emplace_back(start.position + orientation * p);
      radius.push_back(size);
    }
  }

  std::mt19937_64 random_;
};

}  // namespace eigengrain::test
