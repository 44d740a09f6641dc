#include "eigengrain/base/error.hpp"
#include "eigengrain/petsc/session.hpp"

#include "../input.hpp"
#include "../interrupt.hpp"
#include "../relaxing.hpp"
#include "compared_scene.hpp"
#include "relaxation_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

namespace eigengrain::app {
namespace {

using assembly::State;
using relaxation::Method;
using relaxation::Moment;

/// Places of all bodies at moments that get rarer, so that no course needs much memory.
class Places {
 public:
  void note(const State& state, const Moment& at) {
    if (++seen_ < next_) return;
    next_ = std::max(seen_ + 1, static_cast<std::int64_t>(std::ceil(1.1 * static_cast<double>(seen_))));
    moments_.push_back(at);
    places_.push_back(state.model.bodies.position);
  }
  std::vector<Distance> from(const State& end) const {
    const std::vector<Vec3>& last = end.model.bodies.position;
    double radii = 0;
    for (const double radius : end.model.bodies.radius) radii += radius;
    const auto count = static_cast<double>(last.size());
    std::vector<Distance> distances;
    for (std::size_t k = 0; k < moments_.size(); ++k) {
      double squares = 0;
      for (std::size_t i = 0; i < last.size(); ++i)
        squares += shortest(end.model.cell, places_[k][i] - last[i]).squaredNorm();
      distances.push_back({moments_[k], std::sqrt(squares / count) / (radii / count)});
    }
    return distances;
  }

 private:
  std::int64_t seen_ = 0;
  std::int64_t next_ = 1;
  std::vector<Moment> moments_;
  std::vector<std::vector<Vec3>> places_;
};

/// The state is then the end of the run.
MethodRun run_method(Method method, State& state, const Options& options) {
  MethodRun run{.name = std::string(name_of(method))};
  Places places;
  relaxation::RelaxOptions wanted;
  wanted.tolerance = options.tolerance;
  wanted.max_steps = options.max_steps;
  wanted.method = method;
  wanted.interrupted = [] { return interrupted() != 0; };
  wanted.observe = [&](const State& at, const Moment& moment) { places.note(at, moment); };
  try {
    run.result = relaxation::relax(state, wanted);
  } catch (const SolverError& error) {
    run.failure = error.what();
    return run;
  }
  run.distances = places.from(state);
  return run;
}

void relax_all_ways(const Options& options, RelaxedScene& scene) {
  Options of_scene = options;
  of_scene.scene = scene.file;
  const State start = read_input(of_scene).state;
  const assembly::Balance balance = assembly::balance_of(start);
  scene.bodies = start.model.bodies.clumps.empty()
                     ? start.model.bodies.size()
                     : start.model.bodies.size() - std::ssize(start.model.bodies.clumps.member) +
                           start.model.bodies.clumps.size();
  scene.contacts = balance.contacts;
  std::optional<State> explicit_end;
  // The explicit method first: the others are compared with where it ends.
  std::vector<Method> order{Method::explicit_cycle};
  for (const relaxation::NamedMethod& known : relaxation::methods)
    if (known.method != Method::explicit_cycle) order.push_back(known.method);
  for (const Method method : order) {
    State state = start;
    scene.runs.push_back(run_method(method, state, options));
    MethodRun& run = scene.runs.back();
    if (interrupted() != 0) throw Interrupted{interrupted()};
    fmt::print(stderr, "  {}: {}\n", run.name,
               !run.failure.empty() ? run.failure
                                    : fmt::format("{} in {:.2g} s, ratio {:.1e}",
                                                  run.result.converged ? "at rest" : "NOT at rest",
                                                  run.result.seconds, mean_of(run.result)));
    if (!run.failure.empty() || !run.result.converged) continue;
    if (method == Method::explicit_cycle)
      explicit_end = std::move(state);
    else if (explicit_end)
      run.from_explicit = difference_of(*explicit_end, state);
  }
}

}  // namespace

std::optional<Moment> MethodRun::reaches(double ratio) const {
  std::optional<Moment> found;
  for (const Moment& moment : result.course) {
    if (moment.mean > ratio)
      found.reset();
    else if (!found)
      found = moment;
  }
  return found;
}

std::optional<Moment> MethodRun::reaches_end() const {
  if (!result.converged || result.course.empty()) return std::nullopt;
  return reaches(std::max(result.course.back().mean, mean_of(result)));
}

RelaxationReport compare_relaxations(const Options& options) {
  const std::vector<std::string> files = files_of(options.scenes);
  RelaxationReport report{.tolerance = options.tolerance, .scenes = {}};
  petsc::start();  // before the clocks
  note_interrupts();
  for (const std::string& file : files) {
    RelaxedScene& scene = report.scenes.emplace_back(
        RelaxedScene{.name = std::filesystem::path(file).stem().string(), .file = file});
    fmt::print(stderr, "{}\n", scene.name);
    try {
      relax_all_ways(options, scene);
    } catch (const InputError& error) {
      if (files.size() == 1) throw;
      scene.skipped = error.what();
    }
  }
  return report;
}

}  // namespace eigengrain::app
