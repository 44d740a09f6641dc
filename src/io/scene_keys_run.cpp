#include "scene_keys.hpp"

#include <fmt/format.h>

namespace eigengrain::io {

using enum KeyKind;

std::vector<KeyDescription> end_of_run_keys(const std::string& section, const std::string& since) {
  const auto in = [&](const char* key) { return section + key; };
  return {
      {.path = section,
       .kind = KeyKind::section,
       .example = "{steps: 10000}",
       .description = "when the explicit cycle ends: at the first of `steps`, `time` and `until`, one of "
                      "which is wanted; absent: no run"},
      {.path = in(".steps"),
       .kind = integer,
       .range = {.low = 1},
       .example = "10000",
       .description = fmt::format("number of steps since the start of the {}", since)},
      {.path = in(".time"),
       .kind = quantity,
       .unit = "s",
       .range = positive_range,
       .example = "2 s",
       .description = fmt::format("time since the start of the {}", since)},
      {.path = in(".until"),
       .kind = KeyKind::section,
       .example = "{unbalanced: 1e-5}",
       .description = "ends as soon as all of this holds together; looked at every 100 steps"},
      {.path = in(".until.unbalanced"),
       .kind = quantity,
       .range = positive_range,
       .example = "1e-5",
       .description = "the mean unbalanced force ratio is below this, and no ball falls free"},
      {.path = in(".until.kinetic"),
       .kind = quantity,
       .unit = "J",
       .range = positive_range,
       .example = "1e-9 J",
       .description = "the kinetic energy is below this"},
      {.path = in(".until.wall_force"),
       .kind = KeyKind::section,
       .example = "{wall: wall 1 (plane), at_least: 10 N}",
       .description = "the balls press on a wall"},
      {.path = in(".until.wall_force.wall"),
       .kind = text,
       .required = true,
       .example = "wall 1 (plane)",
       .description = "its name, as `check` lists it"},
      {.path = in(".until.wall_force.at_least"),
       .kind = quantity,
       .unit = "N",
       .range = positive_range,
       .required = true,
       .example = "10 N",
       .description = "magnitude of the force on it"},
  };
}

std::vector<KeyDescription> run_keys() {
  std::vector<KeyDescription> keys{
      {.path = "damping", .kind = section, .example = "{local: 0.7}", .description = "numerical damping"},
      {.path = "damping.local",
       .kind = quantity,
       .range = {.low = 0, .high = 1, .high_allowed = false},
       .fallback = "0.7",
       .example = "0.7",
       .description = "the part of the unbalanced force that is held against the motion"},

      {.path = "timestep",
       .kind = section,
       .example = "{policy: estimate, safety: 0.8}",
       .description = "how the explicit timestep is chosen"},
      {.path = "timestep.policy",
       .kind = word,
       .fallback = "estimate",
       .words = {"estimate", "fixed", "bound", "tracked"},
       .example = "bound",
       .description =
           "`estimate`: from the stiffness at each body; `bound`: proven to be safe for all near pairs; "
           "`tracked`: proven to be safe for the contacts, close to the true limit, and proven again when "
           "they "
           "change; `fixed`: `dt`"},
      {.path = "timestep.safety",
       .kind = quantity,
       .range = {.low = 0, .high = 1, .low_allowed = false},
       .fallback = "0.8",
       .example = "0.8",
       .description = "fraction of the estimate or bound in use; `0.98` with policy `tracked`"},
      {.path = "timestep.every",
       .kind = text,
       .fallback = "auto",
       .example = "200",
       .description = "steps after which the policy is asked again even if nothing calls for it; `auto`: 500 "
                      "with `tracked`, "
                      "100 with `estimate` (5 where stiffness follows the overlap), with `bound` only where "
                      "near pairs do "
                      "not say it all"},
      {.path = "timestep.dt",
       .kind = quantity,
       .unit = "s",
       .range = positive_range,
       .example = "10 us",
       .description = "the timestep; needed with policy `fixed`, and only there"},

      {.path = "mass_scaling",
       .kind = section,
       .example = "{form: differential, dt: 1 s}",
       .description = "inertial masses (not weights) chosen so that `dt` is stable; but for `selective`, "
                      "only the steady "
                      "state at the end means anything"},
      {.path = "mass_scaling.form",
       .kind = word,
       .fallback = "differential",
       .words = {"differential", "uniform", "selective", "none"},
       .example = "differential",
       .description =
           "`differential`: of each body for itself; `uniform`: of all by one factor; `selective`: of as few "
           "bodies, by as little, as `dt` needs, in true time; `none`: the true masses, for `--set`"},
      {.path = "mass_scaling.dt",
       .kind = quantity,
       .unit = "s",
       .range = positive_range,
       .required = true,
       .example = "1 s",
       .description = "the step; it is `timestep.safety` times one that is proven stable"},

  };
  const std::vector<KeyDescription> end = end_of_run_keys("run", "scene");
  keys.insert(keys.end(), end.begin(), end.end());
  return keys;
}

}  // namespace eigengrain::io
