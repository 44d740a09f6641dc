#include "relaxing.hpp"

#include "eigengrain/petsc/session.hpp"

#include "interrupt.hpp"

#include <fmt/format.h>

#include <string>

namespace eigengrain::app {

relaxation::RelaxResult relax_with_reports(assembly::State& state, double tolerance, std::int64_t max_steps,
                                           relaxation::Method method) {
  petsc::start();  // before the clock
  note_interrupts();
  relaxation::RelaxOptions wanted;
  wanted.tolerance = tolerance;
  wanted.max_steps = max_steps;
  wanted.method = method;
  wanted.report = [](const std::string& line) { fmt::print(stderr, "{}\n", line); };
  wanted.interrupted = [] { return interrupted() != 0; };
  const relaxation::RelaxResult result = relaxation::relax(state, wanted);
  for (assembly::BondBreak& found : state.breaks) {  // relaxation has steps, but no time
    found.step = state.step;
    found.time = state.time;
  }
  return result;
}

}  // namespace eigengrain::app
