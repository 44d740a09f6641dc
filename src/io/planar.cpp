#include "scene_draft.hpp"

#include <fmt/format.h>

#include <cmath>
#include <string_view>

/// Scenes in a plane.
namespace eigengrain::io {
namespace {

constexpr std::string_view axis_names = "xyz";

/// How far centres may lie from the plane of the first, in radii: files round.
constexpr double tolerance = 1e-6;

void check_places(const SceneDraft& draft, int normal, double plane, Diagnostics& diagnostics) {
  const model::Bodies& balls = draft.scene.bodies;
  for (std::size_t i = 0; i < balls.position.size(); ++i) {
    const double way = balls.position[i][normal] - plane;
    if (std::abs(way) <= tolerance * balls.radius[i]) continue;
    diagnostics.add(
        draft.ball_places.of(static_cast<std::int32_t>(i)),
        fmt::format("ball {0}: {1} = {2} m, and ball 0 has {1} = {3} m; the balls of a planar scene lie in "
                    "one plane: move the ball, or say `planar: {{normal: ...}}`",
                    i, axis_names[static_cast<std::size_t>(normal)], balls.position[i][normal], plane),
        "out of the plane");
  }
}

/// Loads that the plane would have to bear.
void check_loads(const SceneDraft& draft, int normal, Diagnostics& diagnostics) {
  const model::Bodies& balls = draft.scene.bodies;
  const char axis = axis_names[static_cast<std::size_t>(normal)];
  for (std::size_t i = 0; i < balls.applied_force.size(); ++i)
    if (balls.applied_force[i][normal] != 0)
      diagnostics.add(
          draft.ball_places.of(static_cast<std::int32_t>(i)),
          fmt::format("ball {}: a force of {} N along {}, across the plane, where nothing can move; "
                      "write 0 there",
                      i, balls.applied_force[i][normal], axis),
          "force out of the plane");
  for (std::size_t i = 0; i < balls.applied_moment.size(); ++i)
    for (int k = 0; k < 3; ++k)
      if (k != normal && balls.applied_moment[i][k] != 0)
        diagnostics.add(
            draft.ball_places.of(static_cast<std::int32_t>(i)),
            fmt::format("ball {}: a moment of {} N m about {}; in a planar scene balls turn about {} alone: "
                        "write 0 there",
                        i, balls.applied_moment[i][k], axis_names[static_cast<std::size_t>(k)], axis),
            "moment out of the plane");
}

/// Given motions that would never happen, as the components are fixed at them, or would for ever.
void check_motion(const SceneDraft& draft, int normal, Diagnostics& diagnostics) {
  const model::Bodies& balls = draft.scene.bodies;
  const char axis = axis_names[static_cast<std::size_t>(normal)];
  for (std::size_t i = 0; i < balls.velocity.size(); ++i)
    if (balls.velocity[i][normal] != 0)
      diagnostics.add(draft.ball_places.of(static_cast<std::int32_t>(i)),
                      fmt::format("ball {}: a velocity of {} m/s along {} leaves the plane; write 0 there", i,
                                  balls.velocity[i][normal], axis),
                      "velocity out of the plane");
  for (std::size_t i = 0; i < balls.spin.size(); ++i)
    for (int k = 0; k < 3; ++k)
      if (k != normal && balls.spin[i][k] != 0)
        diagnostics.add(
            draft.ball_places.of(static_cast<std::int32_t>(i)),
            fmt::format("ball {}: a spin of {} rad/s about {}; in a planar scene balls turn about "
                        "{} alone: write 0 there",
                        i, balls.spin[i][k], axis_names[static_cast<std::size_t>(k)], axis),
            "spin out of the plane");
}

}  // namespace

void read_planar(const Section& root, SceneDraft& draft) {
  const auto section = root.section("planar");
  if (!section) return;
  section->check_keys();
  const auto shape = section->text("shape");
  const auto normal = section->text("normal");
  if (!shape || !normal) return;
  draft.planar = Plane2d{.normal = static_cast<int>(axis_names.find(*normal)), .disks = *shape == "disk"};
}

void check_planar_balls(const SceneDraft& draft, double plane, Diagnostics& diagnostics) {
  if (!draft.planar) return;
  check_places(draft, draft.planar->normal, plane, diagnostics);
  check_motion(draft, draft.planar->normal, diagnostics);
  check_loads(draft, draft.planar->normal, diagnostics);
}

void check_planar(const Section& root, const SceneDraft& draft) {
  if (!draft.planar) return;
  const int normal = draft.planar->normal;
  if (draft.scene.gravity[normal] != 0)
    root.report("gravity",
                fmt::format("{} m/s2 along {}, across the plane, where nothing can move; write 0 there",
                            draft.scene.gravity[normal], axis_names[static_cast<std::size_t>(normal)]));
  if (!draft.scene.bodies.position.empty())
    check_planar_balls(draft, draft.scene.bodies.position[0][normal], root.diagnostics());
}

}  // namespace eigengrain::io
