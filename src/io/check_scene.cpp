#include "eigengrain/assembly/contact_list.hpp"

#include "coincidence.hpp"
#include "scene_draft.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <span>
#include <type_traits>
#include <utility>
#include <variant>

namespace eigengrain::io {
namespace {

/// How many balls each material has, or will have: those that stages add count as two.
std::vector<std::int64_t> balls_of_materials(const SceneDraft& draft) {
  std::vector<std::int64_t> count(draft.scene.materials.size());
  for (const std::int32_t material : draft.scene.bodies.material)
    if (material >= 0) ++count[material];
  for (const std::int32_t material : draft.materials_to_come) count[material] += 2;
  return count;
}

void check_densities(const SceneDraft& draft, Diagnostics& diagnostics) {
  const std::vector<std::int64_t> balls = balls_of_materials(draft);
  for (std::size_t k = 0; k < balls.size(); ++k) {
    const model::Material& material = draft.scene.materials[k];
    if (balls[k] > 0 && material.density == 0)
      diagnostics.add(
          draft.material_places[k],
          fmt::format("materials[{}]: density is missing, and balls are made of \"{}\"; add e.g. \"density: "
                      "2500 kg/m3\"",
                      k, material.name));
  }
}

void check_rules(const Section& root, const SceneDraft& draft) {
  const model::Scene& scene = draft.scene;
  if (!draft.contacts_complete) return;
  for (const auto& [a, b] : meeting_pairs(draft)) {
    if (scene.rule_for(a, b) >= 0) continue;
    root.report(
        "contacts",
        fmt::format("no entry for \"{0}\" and \"{1}\", which can meet; add e.g. \"- {{between: [{0}, "
                    "{1}], law: linear, kn: 1e5 N/m}}\", or \"law: none\" if they do not see each other",
                    scene.materials[a].name, scene.materials[b].name));
  }
}

double height_above(const model::Plane& wall, const Vec3& x) {
  return wall.normal.dot(x - wall.point);
}

void report_behind(const SceneDraft& draft, std::int32_t ball, const model::Plane& wall,
                   Diagnostics& diagnostics) {
  const Vec3& x = draft.scene.bodies.position[ball];
  const double height = height_above(wall, x);
  const std::string where = height == 0 ? "on" : fmt::format("{:.6g} m behind", -height);
  diagnostics.add(
      draft.ball_places.of(ball),
      fmt::format("ball {}: its centre ({}, {}, {}) lies {} {}, whose normal ({:.6g}, {:.6g}, {:.6g}) "
                  "points to the active side; move the ball, or turn the wall around",
                  ball, x[0], x[1], x[2], where, wall.name, wall.normal[0], wall.normal[1], wall.normal[2]),
      "behind " + wall.name);
}

/// Balls that start on or behind a wall would be pushed nowhere or out of the wrong side.
void check_walls(const SceneDraft& draft, Diagnostics& diagnostics) {
  const model::Scene& scene = draft.scene;
  for (std::size_t w = 0; w < scene.walls.size(); ++w) {
    const model::Plane& wall = scene.walls[w];
    const auto behind = [&](const Vec3& x) { return !(height_above(wall, x) > 0); };
    const auto& centres = scene.bodies.position;
    if (centres.size() > 1 && std::all_of(centres.begin(), centres.end(), behind)) {
      diagnostics.add(
          draft.wall_places[w],
          fmt::format("{}: every ball lies behind it; its normal ({:.6g}, {:.6g}, {:.6g}) must point to the "
                      "active side, where the balls are",
                      wall.name, wall.normal[0], wall.normal[1], wall.normal[2]));
      continue;
    }
    for (std::size_t i = 0; i < centres.size(); ++i)
      if (behind(centres[i])) report_behind(draft, static_cast<std::int32_t>(i), wall, diagnostics);
  }
}

/// Whether two walls are one plane, up to rounding.
bool coincide(const model::Plane& first, const model::Plane& second) {
  const double distance = std::abs(height_above(first, second.point));
  const double size = 1e-12 * (first.point.norm() + second.point.norm());
  return first.normal.dot(second.normal) > 1 - 1e-12 && distance <= size;
}

void check_coincidence(const SceneDraft& draft, Diagnostics& diagnostics) {
  const model::Bodies& bodies = draft.scene.bodies;
  for (const auto& [first, second] : coincident_balls(bodies.position, bodies.radius, draft.scene.cell)) {
    const Vec3& x = bodies.position[second];
    diagnostics.add(
        draft.ball_places.of(second),
        fmt::format("ball {} has the centre ({}, {}, {}) of ball {} ({}), so their contact has no "
                    "direction; move or remove one",
                    second, x[0], x[1], x[2], first, text_of(draft.ball_places.of(first))),
        "coincident");
  }
}

/// Longest side of the box around points, m.
double extent_of(std::span<const Vec3> points) {
  Vec3 low = points.front();
  Vec3 high = points.front();
  for (const Vec3& x : points) {
    low = low.cwiseMin(x);
    high = high.cwiseMax(x);
  }
  return (high - low).maxCoeff();
}

/// A surface in a wrong unit is a thousand times too large or too small.
void note_size(const model::Surface& surface, model::Scene& scene) {
  if (scene.bodies.radius.empty()) return;  // of a state
  const auto [least, most] = std::minmax_element(scene.bodies.radius.begin(), scene.bodies.radius.end());
  const double size = extent_of(surface.vertices);
  const double balls = extent_of(scene.bodies.position) + 2 * *most;
  const bool large = size > 300 * balls && size > 3000 * *most;
  if (large || size < 0.03 * *least)
    scene.notes.push_back(
        fmt::format("{} is {:.3g} m in size, and the balls, of radius {:.3g} to {:.3g} m, "
                    "take {:.3g} m; is its unit right?",
                    surface.name, size, *least, *most, balls));
}

}  // namespace

std::set<std::pair<std::int32_t, std::int32_t>> meeting_pairs(const SceneDraft& draft) {
  const model::Scene& scene = draft.scene;
  const std::vector<std::int64_t> balls = balls_of_materials(draft);
  const auto count = static_cast<std::int32_t>(balls.size());
  const auto balls_of = [&](std::int32_t material) { return balls[material]; };
  std::set<std::pair<std::int32_t, std::int32_t>> pairs;
  for (std::int32_t a = 0; a < count; ++a) {
    if (balls_of(a) == 0) continue;
    // A single ball can still meet its own periodic image.
    if (balls_of(a) > 1 || scene.cell.any()) pairs.insert({a, a});
    for (std::int32_t b = a + 1; b < count; ++b)
      if (balls_of(b) > 0) pairs.insert({a, b});
    for (const model::Plane& wall : scene.walls)
      if (wall.material >= 0) pairs.insert(std::minmax(a, wall.material));
    for (const model::Surface& wall : scene.surfaces)
      if (wall.material >= 0) pairs.insert(std::minmax(a, wall.material));
    for (const model::Deformable& body : scene.deformables) pairs.insert(std::minmax(a, body.material));
  }
  for (const model::Deformable& body : scene.deformables)
    for (const model::Plane& wall : scene.walls)
      if (wall.material >= 0) pairs.insert(std::minmax(body.material, wall.material));
  return pairs;
}

void add_notes(SceneDraft& draft) {
  model::Scene& scene = draft.scene;
  for (std::size_t second = 1; second < scene.walls.size(); ++second)
    for (std::size_t first = 0; first < second; ++first)
      if (coincide(scene.walls[first], scene.walls[second]))
        scene.notes.push_back(
            fmt::format("{} and {} lie in one plane: balls there touch both, so they count twice",
                        scene.walls[first].name, scene.walls[second].name));
  for (const model::Surface& surface : scene.surfaces) note_size(surface, scene);
  if (scene.mass_scaling && !model::keeps_time(scene.mass_scaling))
    scene.notes.push_back(
        fmt::format("masses are scaled ({}) so that a step of {:g} s is stable: only the steady state at the "
                    "end means anything, and times and velocities count in these seconds",
                    model::name_of(scene.mass_scaling->form), scene.mass_scaling->dt));
  else if (scene.mass_scaling)
    scene.notes.push_back(fmt::format(
        "some bodies are made heavier where a step of {:g} s needs it: they move as if they were, but "
        "for their weight",
        scene.mass_scaling->dt));
}

void check_scene(const Section& root, const SceneDraft& draft) {
  check_densities(draft, root.diagnostics());
  check_rules(root, draft);
}

void check_mass_scaling(const Section& root, const SceneDraft& draft) {
  const model::Scene& scene = draft.scene;
  if (!scene.mass_scaling) return;
  if (std::any_of(scene.histories.begin(), scene.histories.end(),
                  [](const model::History& table) { return table.ledger; }))
    root.report("mass_scaling",
                "beside a table of the ledger, which has no meaning there; remove mass_scaling, or leave "
                "`ledger` out of `histories`");
  if (root.diagnostics().any()) return;  // a law may be incomplete
  if (model::keeps_time(scene.mass_scaling)) return;
  for (std::size_t r = 0; r < scene.contacts.size(); ++r) {
    const model::ContactRule& rule = scene.contacts[r];
    if (rule.law == "none") continue;
    const contact::AnyGroup group =
        assembly::new_group(contact::BallBall::name, rule, static_cast<std::int32_t>(r));
    const bool dashpots = std::visit(
        [](const auto& g) {
          if constexpr (contact::asks_rate<typename std::decay_t<decltype(g)>::LawType>)
            return g.law.damping().normal > 0 || g.law.damping().shear > 0;
          else
            return false;
        },
        group);
    if (!dashpots) continue;
    root.report("mass_scaling",
                fmt::format("beside the dashpots of contacts[{}], whose velocities have no meaning there; "
                            "remove mass_scaling, or leave beta_n, beta_s and restitution out",
                            rule.entry));
    return;
  }
}

void check_deformation(const Section& root, const SceneDraft& draft) {
  const Mat3& gradient = draft.scene.cell.velocity_gradient;
  if (gradient.isZero(0)) return;
  constexpr std::string_view key = "periodic";
  constexpr std::string_view rest = "or take out its velocity_gradient";
  if (!draft.scene.surfaces.empty())
    root.report(key, fmt::format("a cell that deforms, and {} that cannot; take planes instead, {}",
                                 draft.scene.surfaces.front().name, rest));
  for (const model::History& table : draft.scene.histories)
    if (table.ledger)
      root.report(key,
                  fmt::format("a cell that deforms, whose work the ledger of \"{}\" does not count; take "
                              "`energies` there, {}",
                              table.file, rest));
  if (!draft.planar) return;
  const int normal = draft.planar->normal;
  if (!gradient.row(normal).isZero(0) || !gradient.col(normal).isZero(0))
    root.report(key, fmt::format("a velocity_gradient along {}, across the plane, where nothing can move; "
                                 "write 0 in its row and its column",
                                 "xyz"[normal]));
}

void check_placement(const Section& root, const SceneDraft& draft) {
  check_walls(draft, root.diagnostics());
  check_coincidence(draft, root.diagnostics());
}

}  // namespace eigengrain::io
