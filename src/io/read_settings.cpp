#include "read_selection.hpp"
#include "scene_draft.hpp"

#include <fmt/format.h>

#include <charconv>
#include <optional>
#include <string>
#include <system_error>

namespace eigengrain::io {

void read_gravity(const Section& root, SceneDraft& draft) {
  draft.scene.gravity = root.vector("gravity").value_or(Vec3::Zero());
}

namespace {

constexpr std::string_view axis_names = "xyz";

/// Reports entries that would move what does not repeat.
void check_gradient(const Section& section, const model::PeriodicCell& cell) {
  const Mat3& gradient = cell.velocity_gradient;
  if (!gradient.allFinite()) return;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      if (gradient(i, j) == 0) continue;
      const int open = !cell.periodic[static_cast<std::size_t>(i)] ? i : j;
      if (cell.periodic[static_cast<std::size_t>(open)]) continue;
      section.report(
          "velocity_gradient",
          fmt::format("{0} /s in row {1}, column {2}, and the cell does not repeat along {3}; write 0 "
                      "there, or add {3} to axes",
                      gradient(i, j), i + 1, j + 1, axis_names[static_cast<std::size_t>(open)]));
    }
}

void read_gradient(const Section& section, model::PeriodicCell& cell) {
  const auto rows = section.vectors("velocity_gradient");
  if (!rows || rows->empty()) return;
  if (rows->size() != 3)
    return section.report(
        "velocity_gradient",
        fmt::format("{} rows; three are wanted, e.g. [[0, 0, 0.5], [0, 0, 0], [0, 0, 0]]", rows->size()));
  for (int i = 0; i < 3; ++i)
    cell.velocity_gradient.row(i) = (*rows)[static_cast<std::size_t>(i)].transpose();
  check_gradient(section, cell);
}

}  // namespace

void read_periodic(const Section& root, SceneDraft& draft) {
  const auto section = root.section("periodic");
  if (!section) return;
  section->check_keys();
  const auto lengths = section->vector("box");
  const auto origin = section->vector("origin");
  const auto axes = section->texts("axes");
  if (axes && axes->empty()) section->report("axes", "empty; name at least one axis, or remove periodic");
  if (!lengths || !origin || !axes) return;
  model::PeriodicCell cell = model::PeriodicCell::box(*origin, *lengths, {});
  for (const std::string& axis : *axes) {
    const int k = axis[0] - 'x';
    if ((*lengths)[k] > 0) {
      cell.periodic[k] = true;
    } else {
      section->report("box", fmt::format("length {} m along {}; a periodic axis wants a length > 0",
                                         (*lengths)[k], axis));
    }
  }
  read_gradient(*section, cell);
  draft.scene.cell = cell;
}

void read_damping(const Section& root, SceneDraft& draft) {
  const auto section = root.section("damping");
  if (!section) return;
  section->check_keys();
  draft.scene.local_damping = section->quantity("local").value_or(draft.scene.local_damping);
}

namespace {

/// A number of steps, or zero for "auto".
std::int64_t read_every(const Section& section) {
  const std::string given = section.text("every").value_or("auto");
  if (given == "auto") return 0;
  std::int64_t steps = 0;
  const auto [end, error] = std::from_chars(given.data(), given.data() + given.size(), steps);
  if (error == std::errc() && end == given.data() + given.size() && steps > 0) return steps;
  section.report("every", fmt::format("\"{}\" is neither auto nor a whole number of steps above 0", given));
  return 0;
}

}  // namespace

void read_timestep(const Section& root, SceneDraft& draft) {
  const auto section = root.section("timestep");
  if (!section) return;
  section->check_keys();
  model::TimestepChoice& choice = draft.scene.timestep;
  choice.safety = section->quantity("safety").value_or(choice.safety);
  choice.dt = section->quantity("dt");
  const auto policy = section->text("policy");
  if (!policy) return;
  using Policy = model::TimestepPolicy;
  for (const Policy known : {Policy::estimate, Policy::bound, Policy::tracked, Policy::fixed})
    if (*policy == model::name_of(known)) choice.policy = known;
  const bool fixed = choice.policy == Policy::fixed;
  if (!section->has("safety")) choice.safety = model::default_safety(choice.policy);
  choice.every = read_every(*section);
  if (section->has("every") && fixed)
    section->report("every", "has no meaning with policy fixed; remove it, or write policy: tracked");
  if (fixed && !section->has("dt")) section->report_missing("dt", ", which policy fixed needs");
  if (!fixed && section->has("dt"))
    section->report(
        "dt", fmt::format("has no meaning with policy {}; write \"policy: fixed\" or remove dt", *policy));
}

void read_mass_scaling(const Section& root, SceneDraft& draft) {
  const auto section = root.section("mass_scaling");
  if (!section) return;
  section->check_keys();
  const auto form = section->text("form");
  const auto dt = section->quantity("dt");
  if (!form || !dt || *form == "none") return;
  using enum model::MassScaling::Form;
  const auto chosen = *form == "uniform" ? uniform : *form == "selective" ? selective : differential;
  draft.scene.mass_scaling = model::MassScaling{.form = chosen, .dt = *dt};
  if (draft.scene.timestep.policy == model::TimestepPolicy::fixed)
    section->report("dt", "beside a timestep of policy fixed, which has another dt; remove one of the two");
}

namespace {

std::optional<model::WallForceGoal> read_wall_force(const Section& section, const SceneDraft& draft) {
  section.check_keys();
  const auto wall = section.text("wall");
  const auto force = section.quantity("at_least");
  if (!wall || !force) return std::nullopt;
  check_wall_name(section, *wall, draft);
  return model::WallForceGoal{*wall, *force};
}

void read_until(const Section& section, const SceneDraft& draft, model::RunChoice& run) {
  section.check_keys();
  run.unbalanced = section.quantity("unbalanced");
  run.kinetic = section.quantity("kinetic");
  if (const auto wall_force = section.section("wall_force"))
    run.wall_force = read_wall_force(*wall_force, draft);
  if (!section.has("unbalanced") && !section.has("kinetic") && !section.has("wall_force"))
    section.report("says nothing; add e.g. \"unbalanced: 1e-5\", or remove it");
}

}  // namespace

model::RunChoice read_end_of_run(const Section& section, const SceneDraft& draft) {
  section.check_keys();
  model::RunChoice run;
  run.steps = section.integer("steps");
  run.time = section.quantity("time");
  if (const auto until = section.section("until")) read_until(*until, draft, run);
  if (!section.has("steps") && !section.has("time") && !section.has("until"))
    section.report(
        "says nothing; add \"steps: 10000\", \"time: 2 s\" or \"until: {unbalanced: 1e-5}\", or remove it");
  return run;
}

void read_run(const Section& root, SceneDraft& draft) {
  if (const auto section = root.section("run")) draft.scene.run = read_end_of_run(*section, draft);
}

}  // namespace eigengrain::io
