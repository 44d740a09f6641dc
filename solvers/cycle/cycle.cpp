#include "eigengrain/cycle/cycle.hpp"

#include "eigengrain/assembly/contact_list.hpp"
#include "eigengrain/assembly/selection.hpp"
#include "eigengrain/base/assert.hpp"
#include "eigengrain/base/error.hpp"
#include "eigengrain/base/parallel.hpp"
#include "eigengrain/contact/orientation.hpp"

#include "clump_motion.hpp"
#include "growth.hpp"
#include "kick.hpp"
#include "own_properties.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

namespace eigengrain::cycle {
namespace {

using assembly::State;

/// Part of the mean radius that near pairs may be apart: in a settled bed it adds few pairs and lists last
/// for thousands of steps.
constexpr double skin_of_radius = 0.05;

/// Of balls; where there are none, of what stands for them: twice the edge of a cube of an element's volume.
double mean_radius(const model::Scene& scene) {
  const std::vector<double>& radius = scene.bodies.radius;
  const auto balls = std::ssize(radius) - std::ranges::count(radius, 0.0);
  if (balls > 0) return std::accumulate(radius.begin(), radius.end(), 0.0) / static_cast<double>(balls);
  double mass = 0;
  double elements = 0;
  double density = 1;
  for (const model::Deformable& deformable : scene.deformables) {
    density = deformable.density;
    elements += deformable.mesh.element_count();
  }
  for (const double m : scene.bodies.mass) mass += m;
  return elements > 0 ? 2 * std::cbrt(mass / density / elements) : 0.0;
}

/// What bodies do to the walls in a step, by the trapezoidal rule, J.
double work_on_walls(const std::vector<assembly::WallLoad>& before,
                     const std::vector<assembly::WallLoad>& after, const assembly::WallStep& step) {
  double work = 0;
  for (std::size_t w = 0; w < step.side.size(); ++w)
    work += 0.5 * ((before[w].force + after[w].force).dot(step.side[w].translation) +
                   (before[w].moment + after[w].moment).dot(step.side[w].rotation));
  return work;
}

/// While radii change the step is asked for this often, and when they have come to their end: by then masses
/// are others.
constexpr std::int64_t steps_between_growing = 20;

/// Bodies are looked at for whether they left their rooms at least this often.
constexpr std::int64_t steps_between_looks = 1000;

constexpr double infinity = std::numeric_limits<double>::infinity();

}  // namespace

State start(const model::Scene& scene) {
  State state;
  state.settings = scene;
  state.settings.bodies = {};
  state.list.skin = skin_of_radius * mean_radius(scene);
  state.model = assembly::build_model(scene, state.list.skin);
  model::Bodies& bodies = state.model.bodies;
  const auto count = static_cast<std::size_t>(bodies.size());
  if (bodies.velocity.empty()) bodies.velocity.assign(count, Vec3::Zero());
  if (bodies.spin.empty() && (assembly::needs_rotation(scene) || !bodies.applied_moment.empty()))
    bodies.spin.assign(count, Vec3::Zero());
  assembly::begin_list(state);
  assembly::renew_forces(state);
  assembly::make_groups(bodies, scene.groups, state.groups);
  return state;
}

Cycle::Cycle(State state, TimestepPolicy policy)
    : state_(std::move(state)),
      policy_(std::move(policy)),
      forces_(state_.model, state_.turns()),
      walls_(state_.model) {
  if (std::ssize(state_.list.position) != state_.model.bodies.size() ||
      state_.list.wall_lever.size() != state_.model.wall_poses.size())
    list_anew();
  if (!policy_.keeps_guard || state_.next_dt == 0) state_.guard.reset();
  EIGENGRAIN_ASSERT(!state_.guard || std::ssize(state_.guard->position) == state_.model.bodies.size());
  if (state_.next_dt == 0) choose_timestep();
  EIGENGRAIN_ASSERT(!state_.ledger || !state_.model.cell.deforms());  // refused by begin_ledger
}

template <class Work, class Properties, class Cell>
double Cycle::move(double duration, double dt, const Cell& cell) {
  constexpr std::int64_t chunk_size = 1024;
  model::Bodies& bodies = state_.model.bodies;
  const Properties own(state_.model);
  const Vec3 no_spin = Vec3::Zero();
  const bool clumps = !bodies.clumps.empty();
  if (clumps) move_clumps<Work>(state_, duration, dt, cell);
  const std::int64_t chunks = (bodies.size() + chunk_size - 1) / chunk_size;
  std::vector<double> fastest(static_cast<std::size_t>(chunks), 0.0);
  std::vector<assembly::EnergyIntegrals> works(Work::counts ? static_cast<std::size_t>(chunks) : 0);
  for_chunks(bodies.size(), chunk_size, [&](std::int64_t begin, std::int64_t end, std::int64_t chunk) {
    double largest = 0;
    Work work(state_.dt, dt);
    for (auto i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end); ++i) {
      if (!clumps || bodies.clumps.of(static_cast<std::int32_t>(i)) == model::Clumps::none) {
        const model::FixedComponents fixed = bodies.fixed[i];
        const double damping = own.damping(i);
        const Vec3 force = state_.force[i] + own.load(i);
        kick(bodies.velocity[i], force, own.mass(i), duration, damping, fixed.translation(), work,
             FlowAt<Cell>(cell, bodies.position[i]));
        work.gravity(bodies.mass[i] * state_.model.gravity, bodies.velocity[i]);
        bodies.position[i] += dt * bodies.velocity[i];
        if (state_.turns())
          kick(bodies.spin[i], own.with_applied(i, state_.moment[i]), own.moment_of_inertia(i), duration,
               damping, fixed.rotation(), work, NoFlow{});
        own.count_applied(i, bodies.velocity[i], state_.turns() ? bodies.spin[i] : no_spin, work);
      }
      const double squared = bodies.velocity[i].squaredNorm();
      // Not a number counts as infinitely fast, and the list is renewed until somebody looks.
      if (!(squared <= largest)) largest = std::isnan(squared) ? infinity : squared;
    }
    if (!bodies.orientation.empty())
      for (auto i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end); ++i)
        bodies.orientation[i] = contact::turned(bodies.orientation[i], dt * bodies.spin[i]);
    fastest[chunk] = largest;
    if constexpr (Work::counts) works[chunk] = work.sum;
  });
  for (const assembly::EnergyIntegrals& work : works) state_.ledger->integrals += work;
  return std::sqrt(*std::max_element(fastest.begin(), fastest.end()));
}

template <class Cell>
double Cycle::least_slack(double room, const Cell& cell) const {
  constexpr std::int64_t chunk_size = 1024;
  const std::vector<Vec3>& position = state_.model.bodies.position;
  const std::vector<Vec3>& from = state_.guard ? state_.guard->position : state_.list.position;
  std::vector<double> least((position.size() + chunk_size - 1) / chunk_size, infinity);
  for_chunks(std::ssize(position), chunk_size, [&](std::int64_t begin, std::int64_t end, std::int64_t chunk) {
    for (auto i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end); ++i) {
      double way = 0;
      if constexpr (Cell::moves)
        way = (position[i] - cell.carried(from[i])).norm();
      else
        way = (position[i] - from[i]).norm();
      const double slack = (state_.guard ? state_.guard->room[i] : room) - way;
      if (!(slack >= least[chunk])) least[chunk] = std::isnan(slack) ? -infinity : slack;
    }
  });
  return *std::min_element(least.begin(), least.end());
}

bool Cycle::list_is_old() const {
  const double half_skin = 0.5 * state_.list.skin - state_.list.growth;
  if (!(half_skin >= 0) || !(state_.list.wall_way <= half_skin)) return true;
  for (std::size_t i = 0; i < state_.list.position.size(); ++i)
    if (!((state_.model.bodies.position[i] - state_.list.position[i]).squaredNorm() <= half_skin * half_skin))
      return true;
  return false;
}

void Cycle::list_anew() {
  assembly::renew_list(state_, state_.list.skin);
  forces_ = assembly::ContactForceSum(state_.model, state_.turns());
  slack_ = 0;
}

template <class Cell>
double Cycle::move(double duration, double dt, const Cell& cell) {
  const bool own = EachItsOwn::needed(state_.model.bodies);
  if constexpr (!Cell::moves)  // a ledger does not know the work of a cell that moves
    if (state_.ledger)
      return own ? move<KickWork, EachItsOwn>(duration, dt, cell)
                 : move<KickWork, AllAlike>(duration, dt, cell);
  return own ? move<NoWork, EachItsOwn>(duration, dt, cell) : move<NoWork, AllAlike>(duration, dt, cell);
}

void Cycle::choose_timestep() {
  slack_ = 0;  // a guard may come or go
  if (policy_.prepare) policy_.prepare(state_);
  const double chosen = policy_.dt(state_);
  if (!(chosen > 0) || !std::isfinite(chosen))
    throw InputError(fmt::format(
        "the timestep policy finds no step ({} s): nothing in the scene resists a motion; give one with "
        "timestep: {{policy: fixed, dt: ...}}",
        chosen));
  if (chosen < state_.next_dt || chosen > policy_.worth_a_change * state_.next_dt) state_.next_dt = chosen;
}

void Cycle::step() {
  const double dt = state_.next_dt;
  const double half_skin = 0.5 * state_.list.skin;
  const bool counts_walls = state_.ledger && walls_.any();
  std::vector<assembly::WallLoad> before;
  if (counts_walls) before = assembly::wall_loads(state_.model);
  Growth growth(state_, dt);                  // with walls and bodies where they are at t
  if (walls_.any()) walls_.move(state_, dt);  // first: what drives a wall is its load at t
  const double duration = 0.5 * (state_.dt + dt);
  const bool deforms = state_.model.cell.deforms();
  // Balls of clumps turn about its centre, and rooms shrink as radii grow.
  const bool looks_always = growth.any() || !state_.model.bodies.clumps.empty();
  double slack = 0;
  if (deforms) {
    const assembly::CellStep cell = assembly::move_cell(state_, dt);
    move(duration, dt, cell);
    growth.apply();
    slack = least_slack(cell.margin - state_.list.growth, cell);
    slack_ = 0;  // of a cell at rest nothing is known yet
  } else {
    const assembly::CellAtRest cell;
    slack_ -= dt * move(duration, dt, cell);
    growth.apply();
    // Looked at only where the fastest body could have left its room, beyond the rounding of the sum; and
    // before the rounding of many small steps adds up.
    if (looks_always || !(slack_ > 1e-6 * half_skin) || state_.step % steps_between_looks == 0)
      slack_ = least_slack(half_skin - state_.list.growth, cell);
    slack = slack_;
  }
  bool expired = false;
  bool left_rooms = false;
  if (state_.guard) {
    // While it holds, the list does.
    left_rooms = !(slack >= 0 && state_.list.wall_way <= state_.guard->wall_way);
    expired = left_rooms && list_is_old();
  } else {
    expired = !(slack >= 0 && state_.list.wall_way <= half_skin);
  }
  if (expired) list_anew();
  growth.count();

  model::Bodies& bodies = state_.model.bodies;
  const Mat3 cell_step = dt * state_.model.cell.rate;  // by the edges that the list left
  assembly::BodyForces sum{std::move(state_.force), std::move(state_.moment)};
  forces_.advance(state_.model,
                  {.position = bodies.position,
                   .velocity = bodies.velocity,
                   .spin = bodies.spin,
                   .duration = dt,
                   .orientation = bodies.orientation,
                   .per_second = 1 / dt,
                   .walls = walls_.any() ? &walls_ : nullptr,
                   .cell_step = deforms ? &cell_step : nullptr},
                  sum, state_.ledger ? &state_.ledger->integrals.contacts : nullptr);
  if (counts_walls)
    state_.ledger->integrals.walls -= work_on_walls(before, assembly::wall_loads(state_.model), walls_);
  state_.force = std::move(sum.force);
  state_.moment = std::move(sum.moment);

  state_.dt = dt;
  state_.time += dt;
  ++state_.step;
  if (!forces_.broken().empty()) assembly::note_breaks(state_, forces_.broken());
  const auto due = [&](std::int64_t every) { return every > 0 && state_.step % every == 0; };
  if (expired || left_rooms || due(policy_.every) ||
      (growth.any() && (due(steps_between_growing) || !model::radii_change(state_.model.bodies, state_.time,
                                                                           state_.time + state_.next_dt))))
    choose_timestep();
}

}  // namespace eigengrain::cycle
