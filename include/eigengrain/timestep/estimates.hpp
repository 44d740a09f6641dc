#pragma once

#include "eigengrain/assembly/linear_system.hpp"
#include "eigengrain/assembly/model.hpp"

#include <cstdint>
#include <span>
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
};

struct Answer {
  double dt = 0;              ///< before any safety factor, s; infinite where nothing resists
  std::int64_t products = 0;  ///< products with K that it took
};

struct Estimator {
  std::string_view name;
  std::string_view source;  ///< paper, equation or program
  Claim claim = Claim::none;
  Answer (*find)(const Question& question) = nullptr;
};

/// All of them, those that cost least first.
std::span<const Estimator> estimators();

}  // namespace eigengrain::timestep
