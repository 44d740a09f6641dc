#pragma once

#include "eigengrain/base/vec.hpp"
#include "eigengrain/model/bodies.hpp"

#include "diagnostics.hpp"
#include "scene_draft.hpp"

#include <cstdint>
#include <optional>
#include <string>

namespace eigengrain::io {

/// What an entry of `balls` says of all its balls.
struct BallKind {
  std::int32_t material = -1;
  model::FixedComponents fixed;
  Vec3 velocity;  ///< m/s
  Vec3 spin;      ///< rad/s
  Vec3 force;     ///< applied, N
  Vec3 moment;    ///< applied, N m
  double damping = model::Bodies::scene_damping;
  std::optional<model::RadiusRamp> growth{};  ///< of a radius of its own
};

/// Adds balls to the draft, and remembers where each stands.
class BallList {
 public:
  BallList(SceneDraft& draft, Diagnostics& diagnostics) : draft_(draft), diagnostics_(diagnostics) {}

  /// The file that the next balls stand in.
  void begin_file(const std::string& name) { draft_.ball_places.files.push_back(name); }
  /// A ball that stands on that line.
  void add(const Vec3& position, double radius, const BallKind& kind, std::int32_t line);

 private:
  double density(std::int32_t material) const;
  void report_size(double radius, double mass, std::int32_t line);
  void report_too_many(std::int32_t line);

  SceneDraft& draft_;
  Diagnostics& diagnostics_;
};

}  // namespace eigengrain::io
