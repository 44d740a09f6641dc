#include "eigengrain/timestep/estimates.hpp"

#include "eigengrain/cycle/bounds.hpp"

#include <array>

namespace eigengrain::timestep {
namespace {

constexpr std::array all{
    Estimator{.name = "diagonal",
              .source = "PFC3D 4.0, General Formulation, eq. 1.31",
              .claim = Claim::none,
              .find = [](const Question& q) { return Answer{cycle::diagonal_estimate(q.system)}; },
              .depends_on_frame = true},
    Estimator{.name = "block-bound",
              .source = "docs/theory.md, block bound",
              .claim = Claim::proven,
              .find = [](const Question& q) { return Answer{cycle::block_bound(q.system)}; }},
    Estimator{.name = "scaled-block-bound",
              .source = "docs/theory.md, scaled block bound, 3 sweeps",
              .claim = Claim::proven,
              .find = [](const Question& q) { return Answer{cycle::scaled_block_bound(q.system, 3)}; }},
};

}  // namespace

std::string_view name_of(Claim claim) {
  switch (claim) {
    case Claim::none:
      return "none";
    case Claim::probable:
      return "probable";
    case Claim::proven:
      break;
  }
  return "proven";
}

std::span<const Estimator> estimators() {
  return all;
}

const Estimator* find_estimator(std::string_view name) {
  for (const Estimator& estimator : all)
    if (estimator.name == name) return &estimator;
  return nullptr;
}

}  // namespace eigengrain::timestep
