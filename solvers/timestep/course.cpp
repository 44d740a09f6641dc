#include "course.hpp"

#include "eigengrain/assembly/balance.hpp"
#include "eigengrain/assembly/energies.hpp"
#include "eigengrain/base/error.hpp"
#include "eigengrain/base/timer.hpp"
#include "eigengrain/cycle/cycle.hpp"
#include "eigengrain/cycle/watch.hpp"
#include "eigengrain/measures/ledger.hpp"

#include "impacts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <utility>

namespace eigengrain::timestep {
namespace {

cycle::Cycle started(assembly::State state, double dt, bool with_ledger) {
  assembly::forget_step(state);  // a state that was saved may bring another one along
  state.ledger.reset();
  if (with_ledger) measures::begin_ledger(state);
  return {std::move(state), {.dt = [dt](const assembly::State&) { return dt; }}};
}

std::vector<Vec3> places_of(const model::Bodies& bodies) {
  std::vector<Vec3> result(bodies.position.size());
  for (std::size_t row = 0; row < result.size(); ++row)
    result[static_cast<std::size_t>(bodies.identity[row])] = bodies.position[row];
  return result;
}

double height_of(const assembly::Model& model) {
  if (model.gravity.isZero(0)) return not_there;
  const model::Bodies& bodies = model.bodies;
  double mass = 0;
  double moment = 0;
  const auto add = [&](double m, const Vec3& x) {
    mass += m;
    moment -= m * x.dot(model.gravity.normalized());
  };
  for (std::int32_t row = 0; row < bodies.size(); ++row)
    if (bodies.clumps.of(row) == model::Clumps::none)
      add(bodies.mass[static_cast<std::size_t>(row)], bodies.position[static_cast<std::size_t>(row)]);
  for (std::size_t c = 0; c < bodies.clumps.position.size(); ++c)
    add(bodies.clumps.mass[c], bodies.clumps.position[c]);
  return moment / mass;
}

void add_sample(const assembly::State& state, std::int64_t samples, Course& course) {
  course.places.push_back(places_of(state.model.bodies));
  const assembly::Energies energies = assembly::energies_of(state);
  const auto share = 1 / static_cast<double>(samples);
  course.statistics.kinetic += share * energies.kinetic_product;
  course.statistics.elastic += share * energies.elastic;
  course.energy = std::max(course.energy, energies.kinetic + energies.elastic);
  if (state.ledger)
    course.imbalance = std::max(course.imbalance, std::abs(measures::ledger_of(state).balance_error));
}

/// Steps to the next sample; how the run blew up, if it did.
std::string step_on(cycle::Cycle& cycle, cycle::Watch& watch, std::int64_t steps, Impacts* impacts) {
  try {
    for (std::int64_t k = 0; k < steps; ++k) {
      cycle.step();
      if (impacts != nullptr) impacts->look(cycle.state());
    }
  } catch (const InputError& error) {  // a state that is lost makes mistakes that no user made
    return error.what();
  }
  const auto trouble = watch.look(cycle.state());
  return trouble ? fmt::format("{} before step {}", trouble->what, cycle.state().step) : std::string();
}

/// x - y by the nearest images.
Vec3 difference(const Vec3& x, const Vec3& y, const model::PeriodicCell& cell) {
  Vec3 d = x - y;
  if (!cell.any()) return d;
  const Vec3 cells = cell.inverse() * d;
  for (int k = 0; k < 3; ++k)
    if (cell.periodic[static_cast<std::size_t>(k)]) d -= std::round(cells[k]) * cell.edges.col(k);
  return d;
}

}  // namespace

Course record(const assembly::State& start, const CoursePlan& plan, bool with_ledger, bool with_impacts) {
  cycle::Cycle cycle = started(start, plan.dt, with_ledger);
  cycle::Watch watch(cycle.state());
  Impacts impacts;
  Course course;
  course.statistics.kinetic = 0;
  course.statistics.elastic = 0;
  if (with_ledger) course.imbalance = 0;
  if (with_impacts) impacts.look(cycle.state());
  for (std::int64_t sample = 0; sample < plan.samples; ++sample) {
    course.trouble = step_on(cycle, watch, plan.steps_per_sample, with_impacts ? &impacts : nullptr);
    if (!course.trouble.empty()) return course;
    add_sample(cycle.state(), plan.samples, course);
  }
  const assembly::Balance balance = assembly::balance_of(cycle.state());
  course.statistics.contacts = static_cast<double>(balance.contacts);
  if (balance.contacts > 0) course.statistics.contact_force = balance.mean_contact_force;
  course.statistics.height = height_of(cycle.state().model);
  course.restitution = impacts.restitution();
  return course;
}

double seconds_of(const assembly::State& start, const CoursePlan& plan) {
  constexpr double enough = 0.1;  // the least of some short runs: machines have other things to do
  constexpr int most_runs = 5;
  double least = std::numeric_limits<double>::infinity();
  double total = 0;
  for (int k = 0; k < most_runs && total < enough; ++k) {
    cycle::Cycle cycle = started(start, plan.dt, false);
    const Stopwatch watch;
    cycle.run(plan.steps());
    least = std::min(least, watch.seconds());
    total += watch.seconds();
  }
  return least;
}

double distance(const Course& x, const Course& y, const model::PeriodicCell& cell, std::size_t first) {
  double sum = 0;
  std::size_t count = 0;
  for (std::size_t s = first; s < x.places.size(); ++s)
    for (std::size_t i = 0; i < x.places[s].size(); ++i, ++count)
      sum += difference(x.places[s][i], y.places[s][i], cell).squaredNorm();
  return std::sqrt(sum / static_cast<double>(count));
}

Course extrapolated(const Course& fine, const Course& coarse, int order, const model::PeriodicCell& cell) {
  Course result = fine;
  const double factor = 1 / (std::exp2(order) - 1);
  for (std::size_t s = 0; s < fine.places.size(); ++s)
    for (std::size_t i = 0; i < fine.places[s].size(); ++i)
      result.places[s][i] += factor * difference(fine.places[s][i], coarse.places[s][i], cell);
  return result;
}

}  // namespace eigengrain::timestep
