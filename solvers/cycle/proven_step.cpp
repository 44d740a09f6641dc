#include "proven_step.hpp"

#include "eigengrain/assembly/local_damping.hpp"
#include "eigengrain/cycle/step_prover.hpp"

#include "first_contact.hpp"

#include <algorithm>
#include <limits>

namespace eigengrain::cycle {
namespace {

/// A proof ends where steps larger by this can no more be proven: the last percent costs more than all
/// before.
constexpr double content = 1.03;

}  // namespace

double proven_step(const assembly::State& state, bool varies) {
  const assembly::LinearSystem system(state.model, assembly::Listed::all);
  const std::vector<std::int32_t> apart = bodies_apart(state, system, varies);
  StepProver prover(system, assembly::largest_damping(state.model));
  return std::min(prover.sharpen(std::numeric_limits<double>::infinity(), content),
                  first_contact(state, apart, fastest_approach(state)).bound);
}

}  // namespace eigengrain::cycle
