#include "scene_keys.hpp"

#include <fmt/format.h>

namespace eigengrain::io {

using enum KeyKind;

namespace {

void append(std::vector<KeyDescription>& keys, std::vector<KeyDescription> more) {
  keys.insert(keys.end(), more.begin(), more.end());
}

/// The keys of a selection of balls.
std::vector<KeyDescription> selection_keys(const std::string& section) {
  std::vector<KeyDescription> keys = region_keys(section, "a box");
  append(keys, {{.path = section + ".material",
                 .kind = text,
                 .example = "grain",
                 .description = "only balls of this material"},
                {.path = section + ".balls",
                 .kind = integers,
                 .range = {.low = 0},
                 .example = "[0, 1]",
                 .description = "only balls of these numbers"}});
  return keys;
}

std::vector<KeyDescription> group_keys(const std::string& section, const std::string& when) {
  std::vector<KeyDescription> keys{
      {.path = section,
       .kind = section_list,
       .fallback = "[]",
       .example = "[{name: lid, box: {min: [0, 0, 0.2], max: [1, 1, 1]}}]",
       .description =
           fmt::format("named sets of balls, chosen {}; they keep their balls wherever these go", when)},
      {.path = section + "[].name",
       .kind = text,
       .required = true,
       .example = "lid",
       .description = "by which `bodies` and `contacts` of a stage ask for it"}};
  append(keys, selection_keys(section + "[]"));
  return keys;
}

std::vector<KeyDescription> body_keys() {
  std::vector<KeyDescription> keys{
      {.path = "stages[].bodies",
       .kind = section_list,
       .fallback = "[]",
       .example = "[{group: lid, fix: [x, y], velocity: [0, 0, -0.1]}]",
       .description =
           "changes of balls, one after the other: of those that all keys of the selection mean (`group`, "
           "`sphere`, `box`, `material`, `balls`; none of them: all); a clump changes if any of its balls is "
           "meant"},
      {.path = "stages[].bodies[].group",
       .kind = text,
       .example = "lid",
       .description = "only balls of this group"}};
  append(keys, selection_keys("stages[].bodies[]"));
  append(keys, {{.path = "stages[].bodies[].fix",
                 .kind = words,
                 .fallback = "[]",
                 .words = {"x", "y", "z", "wx", "wy", "wz", "all"},
                 .example = "[x, wy]",
                 .description = "components of motion that keep their value from now on"},
                {.path = "stages[].bodies[].free",
                 .kind = words,
                 .fallback = "[]",
                 .words = {"x", "y", "z", "wx", "wy", "wz", "all"},
                 .example = "all",
                 .description = "components of motion that are no longer fixed"},
                {.path = "stages[].bodies[].velocity",
                 .kind = vector,
                 .unit = "m/s",
                 .example = "[0, 0, -0.1]",
                 .description = "from now on"},
                {.path = "stages[].bodies[].spin",
                 .kind = vector,
                 .unit = "rad/s",
                 .example = "[0, 10, 0]",
                 .description = "angular velocity from now on"},
                {.path = "stages[].bodies[].force",
                 .kind = vector,
                 .unit = "N",
                 .example = "[10 N, 0, 0]",
                 .description = "applied at the centre of each from now on"},
                {.path = "stages[].bodies[].moment",
                 .kind = vector,
                 .unit = "N m",
                 .example = "[0, 0.1, 0]",
                 .description = "applied to each from now on"},
                {.path = "stages[].bodies[].damping",
                 .kind = quantity,
                 .range = {.low = 0, .high = 1, .high_allowed = false},
                 .example = "0.2",
                 .description = "local damping of their own from now on"},
                {.path = "stages[].bodies[].growth",
                 .kind = section,
                 .example = "{factor: 1.05, over: 0.1 s}",
                 .description = "the radius changes at the same density; not of clumps"},
                {.path = "stages[].bodies[].growth.factor",
                 .kind = quantity,
                 .range = positive_range,
                 .required = true,
                 .example = "1.05",
                 .description = "radius at the end over that at the start"},
                {.path = "stages[].bodies[].growth.over",
                 .kind = quantity,
                 .unit = "s",
                 .range = positive_range,
                 .example = "0.1 s",
                 .description = "how long it takes; absent: at once"}});
  return keys;
}

std::vector<KeyDescription> choice_keys() {
  std::vector<KeyDescription> keys{
      {.path = "stages[].contacts",
       .kind = section_list,
       .fallback = "[]",
       .example = "[{take: soft, box: {min: [0, 0, 0], max: [1, 1, 0.1]}}]",
       .description =
           "contacts that act now and the entry of `contacts` that they take: those of which all keys mean "
           "both "
           "balls, or, at a wall, the ball; they go back when they have opened, and bonds and contacts with "
           "polygons and meshes are left alone"},
      {.path = "stages[].contacts[].take",
       .kind = text,
       .required = true,
       .example = "soft",
       .description = "the `name` of an entry of `contacts`"},
      {.path = "stages[].contacts[].wall",
       .kind = text,
       .example = "wall 1 (plane)",
       .description = "only contacts with this wall, by its name as `check` lists it"},
      {.path = "stages[].contacts[].group",
       .kind = text,
       .example = "lid",
       .description = "only balls of this group"}};
  append(keys, selection_keys("stages[].contacts[]"));
  return keys;
}

/// The keys of `run`, which a stage has too.
std::vector<KeyDescription> stage_run_keys() {
  std::vector<KeyDescription> keys = end_of_run_keys("stages[].run", "stage");
  keys.front().description = "the explicit cycle, to the first of `steps`, `time` and `until`";
  return keys;
}

/// The keys of `balls`, which a stage has too.
std::vector<KeyDescription> added_ball_keys() {
  std::vector<KeyDescription> keys;
  for (KeyDescription key : ball_keys()) {
    if (!key.path.starts_with("balls") || key.path == "balls[].mean_overlap") continue;
    if (key.path == "balls[].fill") key.words = {"random"};
    key.path = "stages[]." + key.path;
    if (key.path == "stages[].balls") {
      key.required = false;
      key.fallback = "[]";
      key.example = "[{position: [0.1, 0.1, 0.3], radius: 5 mm, material: grain}]";
      key.description =
          "balls that come in, with the keys of `balls`, numbered on; those that would overlap balls or "
          "walls "
          "are left out; no `fill: dense`; where the stage repeats, `seed` grows by one each time";
    }
    keys.push_back(std::move(key));
  }
  return keys;
}

}  // namespace

std::vector<KeyDescription> stage_keys() {
  std::vector<KeyDescription> keys = group_keys("groups", "when the scene starts");
  append(
      keys,
      {{.path = "stages",
        .kind = section_list,
        .fallback = "[]",
        .example = "[{run: {until: {unbalanced: 1e-4}}}, {set: {gravity: [1, 0, -9.76]}, run: {time: 1 s}}]",
        .description = "a whole test, instead of `run`: what `run` does one after the other. Each stage "
                       "sets, adds balls, "
                       "makes groups, changes bodies, chooses contacts, then runs or relaxes, then saves, in "
                       "this order"},
       {.path = "stages[].name", .kind = text, .example = "tilt", .description = "for reports"},
       {.path = "stages[].repeat",
        .kind = integer,
        .range = {.low = 1},
        .fallback = "1",
        .example = "20",
        .description = "how often the stage is done"},
       {.path = "stages[].set",
        .kind = section,
        .example = "{contacts.0.friction: 0.5}",
        .description =
            "keys of the scene and their new values, as with `--set`; they stay: all but `balls`, `clumps`, "
            "`planar`, `run`, `groups`, `stages`, and what a saved state cannot change"}});
  append(keys, added_ball_keys());
  append(keys, group_keys("stages[].groups", "in this stage"));
  append(keys, body_keys());
  append(keys, choice_keys());
  append(keys, stage_run_keys());
  append(keys,
         {{.path = "stages[].relax",
           .kind = section,
           .example = "{tolerance: 1e-10}",
           .description = "instead of `run`: the equilibrium, as the verb `relax`"},
          {.path = "stages[].relax.tolerance",
           .kind = quantity,
           .range = positive_range,
           .fallback = "1e-10",
           .example = "1e-8",
           .description = "mean unbalanced ratio to reach"},
          {.path = "stages[].relax.max_steps",
           .kind = integer,
           .range = {.low = 1},
           .fallback = "1000000",
           .example = "100000",
           .description = "explicit steps to spend"},
          {.path = "stages[].save",
           .kind = text,
           .example = "tilted.h5",
           .description = "a state in the folder of results; where the stage repeats, its number is added"}});
  return keys;
}

}  // namespace eigengrain::io
