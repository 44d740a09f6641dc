// Times that a wave takes through a ball.
#include "timestep/estimates/rules.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

namespace eigengrain::timestep {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Of each ball that belongs to a body with unknowns: least(radius, material).
template <class Time>
Answer least_over_balls(const Question& question, std::string_view rule, const Time& time) {
  const model::Bodies& bodies = question.model.bodies;
  Answer answer{.dt = infinity};
  if (question.materials.empty()) {
    answer.left_out = "no materials are given";
    return answer;
  }
  for (std::int32_t ball = 0; ball < bodies.size(); ++ball) {
    const auto row = static_cast<std::size_t>(ball);
    if (question.system.unknowns.translation(bodies.clumps.owner(ball)) == assembly::Unknowns::none) continue;
    const model::Material& material = question.materials[static_cast<std::size_t>(bodies.material[row])];
    if (!material.young || !material.poisson) {
      answer.left_out =
          fmt::format("material {} has no young and poisson, of which {} is made", material.name, rule);
      return answer;
    }
    answer.dt = std::min(answer.dt, time(bodies.radius[row], material));
  }
  return answer;
}

}  // namespace

Answer rayleigh(const Question& question) {
  return least_over_balls(question, "a Rayleigh wave", [](double radius, const model::Material& m) {
    const double shear = *m.young / (2 * (1 + *m.poisson));
    return std::numbers::pi * radius * std::sqrt(m.density / shear) / (0.1631 * *m.poisson + 0.8766);
  });
}

Answer p_wave(const Question& question) {
  return least_over_balls(question, "a P-wave", [](double radius, const model::Material& m) {
    return radius * std::sqrt(m.density / *m.young);
  });
}

Answer p_wave_of_stiffness(const Question& question) {
  const model::Bodies& bodies = question.model.bodies;
  if (!bodies.clumps.empty()) return {.left_out = "clumps have no one radius"};
  for (std::size_t i = 0; i < bodies.radius.size(); ++i)
    if (std::abs(bodies.inertia[i] / model::sphere_inertia(bodies.radius[i], bodies.mass[i]) - 1) > 1e-9)
      return {.left_out = "a body is no sphere, so that its mass and radius give no density"};
  std::vector<double> young(bodies.radius.size(), 0.0);
  for (const contact::ContactElement& e : question.system.elements) {
    const double a = bodies.radius[static_cast<std::size_t>(e.a)];
    // YADE takes a wall for a ball of the same radius.
    const double b = e.b == contact::no_body ? a : bodies.radius[static_cast<std::size_t>(e.b)];
    const double modulus = e.stiffness.normal * (a + b) / (2 * a * b);
    young[e.a] = std::max(young[e.a], modulus);
    if (e.b != contact::no_body) young[e.b] = std::max(young[e.b], modulus);
  }
  Answer answer{.dt = infinity};
  for (std::size_t i = 0; i < young.size(); ++i) {
    const std::int32_t block = question.system.unknowns.translation(static_cast<std::int32_t>(i));
    if (young[i] == 0 || block == assembly::Unknowns::none) continue;
    const double density =
        question.system.mass[std::size_t{3} * block] / model::sphere_mass(bodies.radius[i], 1);
    answer.dt = std::min(answer.dt, bodies.radius[i] * std::sqrt(density / young[i]));
  }
  return answer;
}

}  // namespace eigengrain::timestep
