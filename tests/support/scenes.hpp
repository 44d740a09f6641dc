#pragma once

#include "eigengrain/assembly/eigen_matrix.hpp"
#include "eigengrain/assembly/linear_system.hpp"
#include "eigengrain/assembly/model.hpp"
#include "eigengrain/assembly/stiffness.hpp"

#include <cmath>
#include <cstdint>
#include <random>
#include <string>
#include <utility>
#include <vector>

/// Scenes of a few bodies for tests, built in code. Masses are given, not computed from a density, so that
/// closed forms can be written with m = 1.
namespace eigengrain::test {

struct Springs {
  double kn = 1;
  double ks = 0;
  bool tension = true;    ///< linear springs; without it, friction is set so that ks counts
  double friction = 0.5;  ///< where ks counts
  bool small_angle = false;
  bool end_step = false;
};

class SceneBuilder {
 public:
  explicit SceneBuilder(const Springs& springs = {}) {
    scene_.name = "test";
    scene_.materials.push_back({"grain", 1.0});
    scene_.contacts.push_back({.law = "linear",
                               .parameters = {springs.kn, springs.ks, springs.ks > 0 ? springs.friction : 0.0,
                                              springs.tension ? 1.0 : 0.0, springs.small_angle ? 1.0 : 0.0,
                                              springs.end_step ? 1.0 : 0.0}});
    scene_.local_damping = 0;
  }

  SceneBuilder& ball(const Vec3& position, double radius = 1, double mass = 1,
                     model::FixedComponents fixed = {}) {
    model::Bodies& b = scene_.bodies;
    b.identity.push_back(b.size());
    b.position.push_back(position);
    b.radius.push_back(radius);
    b.mass.push_back(mass);
    b.inertia.push_back(model::sphere_inertia(radius, mass));
    b.material.push_back(0);
    b.fixed.push_back(fixed);
    if (!b.velocity.empty()) b.velocity.emplace_back(Vec3::Zero());
    if (!b.spin.empty()) b.spin.emplace_back(Vec3::Zero());
    if (!b.applied_force.empty()) b.applied_force.emplace_back(Vec3::Zero());
    if (!b.applied_moment.empty()) b.applied_moment.emplace_back(Vec3::Zero());
    if (!b.damping.empty()) b.damping.push_back(model::Bodies::scene_damping);
    if (!b.ramp.empty()) b.ramp.emplace_back();
    return *this;
  }
  /// Loads of the ball added last.
  SceneBuilder& loaded(const Vec3& force, const Vec3& moment = Vec3::Zero()) {
    model::Bodies& b = scene_.bodies;
    const Vec3 none = Vec3::Zero();
    if (!b.applied_force.empty()) b.applied_force.pop_back();
    if (!b.applied_moment.empty()) b.applied_moment.pop_back();
    model::add_row(b.applied_force, b.size() - 1, force, none);
    model::add_row(b.applied_moment, b.size() - 1, moment, none);
    return *this;
  }
  /// Local damping of the ball added last.
  SceneBuilder& damped_alone(double alpha) {
    model::Bodies& b = scene_.bodies;
    if (!b.damping.empty()) b.damping.pop_back();
    model::add_row(b.damping, b.size() - 1, alpha, model::Bodies::scene_damping);
    return *this;
  }
  /// The radius of the ball added last grows by a factor.
  SceneBuilder& growing(double factor, double over, double from = 0) {
    model::Bodies& b = scene_.bodies;
    b.ramp.resize(b.position.size());
    b.ramp.back() = {b.radius.back(), b.mass.back(), b.inertia.back(), factor, from, over};
    return *this;
  }
  /// A clump, behind all balls.
  SceneBuilder& clump(const model::ClumpShape& shape, const model::ClumpStart& start) {
    model::add_clump(scene_.bodies, shape, start);
    return *this;
  }
  /// Velocity and spin of the ball added last.
  SceneBuilder& moving(const Vec3& velocity, const Vec3& spin = Vec3::Zero()) {
    model::Bodies& b = scene_.bodies;
    b.velocity.resize(b.position.size(), Vec3::Zero());
    b.velocity.back() = velocity;
    if (b.spin.empty() && spin.isZero(0)) return *this;
    b.spin.resize(b.position.size(), Vec3::Zero());
    b.spin.back() = spin;
    return *this;
  }
  /// Bonds of the scene's one contact rule.
  SceneBuilder& bonded(model::BondRule bond) {
    scene_.contacts.back().bond = std::move(bond);
    return *this;
  }
  /// No law between balls, so that bonds are alone.
  SceneBuilder& without_law() {
    scene_.contacts.back().law = "none";
    scene_.contacts.back().parameters.clear();
    return *this;
  }
  SceneBuilder& gravity(const Vec3& g) {
    scene_.gravity = g;
    return *this;
  }
  SceneBuilder& damped(double local_damping) {
    scene_.local_damping = local_damping;
    return *this;
  }
  SceneBuilder& plane(const Vec3& point, const Vec3& normal) {
    scene_.walls.push_back({point, normal.normalized(), 0, "plane"});
    return *this;
  }
  /// A wall of triangles whose centre is the origin.
  SceneBuilder& surface(model::Surface surface) {
    surface.name = "surface " + std::to_string(scene_.surfaces.size());
    scene_.surfaces.push_back(std::move(surface));
    return *this;
  }
  /// Motion of the surface added last; after all planes.
  SceneBuilder& surface_carried(const Vec3& velocity, const Vec3& spin = Vec3::Zero()) {
    const auto wall = static_cast<std::int32_t>(scene_.walls.size() + scene_.surfaces.size()) - 1;
    scene_.wall_motions.push_back({wall, scene_.surfaces.back().centre, {0.0}, {{velocity, spin}}});
    return *this;
  }
  /// Motion of the plane added last, which turns about `centre`.
  SceneBuilder& carried(const Vec3& velocity, const Vec3& spin = Vec3::Zero(),
                        const Vec3& centre = Vec3::Zero()) {
    scene_.walls.back().centre = centre;
    const auto wall = static_cast<std::int32_t>(scene_.walls.size()) - 1;
    scene_.wall_motions.push_back({wall, centre, {0.0}, {{velocity, spin}}});
    return *this;
  }
  SceneBuilder& periodic(const Vec3& lengths, std::array<bool, 3> axes = {true, true, true}) {
    scene_.cell = model::PeriodicCell::box(Vec3::Zero(), lengths, axes);
    return *this;
  }
  /// The same scene turned about the origin. Only without fixed components and periodic axes.
  SceneBuilder turned(const Mat3& rotation) const {
    SceneBuilder result = *this;
    for (Vec3& x : result.scene_.bodies.position) x = rotation * x;
    for (model::Plane& wall : result.scene_.walls) {
      wall.point = rotation * wall.point;
      wall.normal = rotation * wall.normal;
    }
    return result;
  }

  model::Scene& scene() { return scene_; }
  assembly::Model build() const { return assembly::build_model(scene_); }

 private:
  model::Scene scene_;
};

struct WithModel {
  assembly::Model model;
};

/// A model and its linear system.
struct System : WithModel, assembly::LinearSystem {
  explicit System(assembly::Model m) : WithModel{std::move(m)}, LinearSystem(model) {}
  explicit System(const SceneBuilder& builder) : System(builder.build()) {}

  /// All eigenvalues of M⁻¹K on the free components, increasing.
  Eigen::VectorXd spectrum() const;
};

constexpr model::FixedComponents fix_rotations{0b111000};
constexpr model::FixedComponents fix_all{0b111111};

/// A proper rotation, uniform over all orientations.
Mat3 random_rotation(std::mt19937_64& random);

inline Vec3 random_vector(std::mt19937_64& random) {
  std::normal_distribution<double> gaussian;
  return {gaussian(random), gaussian(random), gaussian(random)};
}

/// A cluster grown ball by ball: each new ball touches one that is there, with some overlap; others that come
/// too near are kept as they come. Radii within a factor `spread`, densities equal, a ball fixed (some or all
/// components) with probability `fixed`.
SceneBuilder random_cluster(std::mt19937_64& random, int balls, const Springs& springs, double spread = 2,
                            double fixed = 0);

}  // namespace eigengrain::test
