#pragma once

#include "eigengrain/assembly/linear_system.hpp"
#include "eigengrain/assembly/model.hpp"
#include "eigengrain/model/material.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

/// The estimates of the undamped critical timestep that are in use, by name.
namespace eigengrain::timestep {

/// What an estimate says of itself.
enum class Claim {
  none,      ///< a rule that scenes may prove wrong
  probable,  ///< safe but for a stated probability of failure
  proven     ///< never above the truth
};

std::string_view name_of(Claim claim);

/// What an estimate is asked about: a model, and its elements, unknowns and masses.
struct Question {
  const assembly::Model& model;
  const assembly::LinearSystem& system;
  /// Of the scene, for rules that ask for moduli; empty: they are left out.
  std::span<const model::Material> materials{};
};

/// Least and largest value of an estimate that depends on the frame, over orientations of the frame, s.
struct Range {
  double least = 0;
  double largest = 0;
};

struct Answer {
  double dt = 0;              ///< before any safety factor, s; infinite where nothing resists
  std::int64_t products = 0;  ///< products with K that it took
  std::optional<Range> range{};
  /// Why the scene has no such estimate; all else then means nothing. Empty where it has.
  std::string left_out{};
};

struct Estimator {
  std::string_view name;
  std::string_view source;  ///< paper, equation or program
  Claim claim = Claim::none;
  Answer (*find)(const Question& question) = nullptr;
  double failure = 0;             ///< probability that it is not safe, where the claim is `probable`
  bool depends_on_frame = false;  ///< whether another orientation of the scene gives another value
  /// Whether it counts more than contacts of two bodies. Where a scene has deformable bodies, others are left
  /// out.
  bool knows_nodes = false;
};

/// All of them, those that cost least first.
std::span<const Estimator> estimators();

/// The one with this name, or null.
const Estimator* find_estimator(std::string_view name);

}  // namespace eigengrain::timestep
