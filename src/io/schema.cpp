#include "eigengrain/io/schema.hpp"

#include "eigengrain/contact/law_table.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace eigengrain::io {
namespace {

using enum KeyKind;

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr Range positive{.low = 0, .low_allowed = false};

/// Everything but the parameters of the laws. The description says what the reader does with the value.
std::vector<KeyDescription> own_keys() {
  return {
      {.path = "gravity",
       .kind = vector,
       .unit = "m/s2",
       .fallback = "[0, 0, 0]",
       .example = "[0, 0, -9.81]",
       .description = "acceleration of every body"},

      {.path = "materials",
       .kind = section_list,
       .example = "[{name: grain, density: 2500}]",
       .description = "what balls and walls are made of"},
      {.path = "materials[].name",
       .kind = text,
       .required = true,
       .example = "grain",
       .description = "any name but `any`, each only once"},
      {.path = "materials[].density",
       .kind = quantity,
       .unit = "kg/m3",
       .range = positive,
       .example = "2500 kg/m3",
       .description = "needed where balls use the material"},

      {.path = "contacts",
       .kind = section_list,
       .example = "[{between: [any, any], law: linear, kn: 1e5 N/m}]",
       .description = "laws between materials; the first entry that matches a pair holds, and every pair "
                      "that can meet needs one"},
      {.path = "contacts[].between",
       .kind = texts,
       .required = true,
       .example = "[any, any]",
       .description = "two names of materials, in any order; `any` stands for each of them"},
      {.path = "contacts[].law",
       .kind = word,
       .required = true,
       .words = law_names(),
       .example = "linear",
       .description = "the contact law, see below; `none`: the two do not see each other"},

      {.path = "balls",
       .kind = section_list,
       .required = true,
       .example = "[{position: [0, 0, 0], radius: 5 mm, material: grain}]",
       .description = "each entry is a packing file or one ball; balls are numbered from 0 in this order"},
      {.path = "balls[].file",
       .kind = text,
       .example = "packing.txt",
       .description = "a packing: `x y z r` a line, in m, `#` starts a comment; the path is relative to the "
                      "scene file"},
      {.path = "balls[].position",
       .kind = vector,
       .unit = "m",
       .example = "[10 mm, 0, 0.3]",
       .description = "centre of one ball; wrapped into the cell where that is periodic"},
      {.path = "balls[].radius",
       .kind = quantity,
       .unit = "m",
       .range = positive,
       .example = "5 mm",
       .description = "needed with `position`"},
      {.path = "balls[].material",
       .kind = text,
       .required = true,
       .example = "grain",
       .description = "a name out of `materials`"},
      {.path = "balls[].fix",
       .kind = words,
       .fallback = "[]",
       .words = {"x", "y", "z", "wx", "wy", "wz", "all"},
       .example = "[x, wy]",
       .description = "components of the velocity and of the angular velocity that keep their value"},
      {.path = "balls[].velocity",
       .kind = vector,
       .unit = "m/s",
       .fallback = "[0, 0, 0]",
       .example = "[0, 0, -1.5]",
       .description = "at the start, of every ball of the entry"},
      {.path = "balls[].spin",
       .kind = vector,
       .unit = "rad/s",
       .fallback = "[0, 0, 0]",
       .example = "[0, 10, 0]",
       .description = "angular velocity at the start, of every ball of the entry"},

      {.path = "walls",
       .kind = section_list,
       .fallback = "[]",
       .example = "[{plane: {point: [0, 0, 0], normal: [0, 0, 1]}, material: grain}]",
       .description = "each entry is a plane or a box; all balls must lie on the active side"},
      {.path = "walls[].plane",
       .kind = section,
       .example = "{point: [0, 0, 0], normal: [0, 0, 1]}",
       .description = "an infinite plane"},
      {.path = "walls[].plane.point",
       .kind = vector,
       .unit = "m",
       .required = true,
       .example = "[0, 0, 0]",
       .description = "any point of the plane"},
      {.path = "walls[].plane.normal",
       .kind = vector,
       .required = true,
       .example = "[0, 0, 1]",
       .description = "points to the active side, where the balls are; of any length but zero"},
      {.path = "walls[].box",
       .kind = section,
       .example = "{min: [0, 0, 0], max: [1, 1, 1], open: [+z]}",
       .description = "up to six infinite planes that face inwards"},
      {.path = "walls[].box.min",
       .kind = vector,
       .unit = "m",
       .required = true,
       .example = "[0, 0, 0]",
       .description = "lower corner"},
      {.path = "walls[].box.max",
       .kind = vector,
       .unit = "m",
       .required = true,
       .example = "[1, 1, 1]",
       .description = "upper corner"},
      {.path = "walls[].box.open",
       .kind = words,
       .fallback = "[]",
       .words = {"-x", "+x", "-y", "+y", "-z", "+z"},
       .example = "[+z]",
       .description = "sides without a wall"},
      {.path = "walls[].material",
       .kind = text,
       .required = true,
       .example = "grain",
       .description = "a name out of `materials`"},

      {.path = "periodic",
       .kind = section,
       .example = "{box: [0.21, 0.21, 0.25]}",
       .description = "a cell that repeats; absent: nothing repeats"},
      {.path = "periodic.box",
       .kind = vector,
       .unit = "m",
       .required = true,
       .example = "[0.21, 0.21, 0.25]",
       .description = "lengths of the cell, > 0 along the axes that repeat"},
      {.path = "periodic.origin",
       .kind = vector,
       .unit = "m",
       .fallback = "[0, 0, 0]",
       .example = "[0, 0, 0]",
       .description = "lower corner of the cell"},
      {.path = "periodic.axes",
       .kind = words,
       .fallback = "[x, y, z]",
       .words = {"x", "y", "z"},
       .example = "[x, y]",
       .description = "the axes along which the cell repeats"},

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
       .words = {"estimate", "fixed", "bound"},
       .example = "bound",
       .description =
           "`estimate`: from the stiffness at each body; `bound`: proven to be safe; `fixed`: `dt`"},
      {.path = "timestep.safety",
       .kind = quantity,
       .range = {.low = 0, .high = 1, .low_allowed = false},
       .fallback = "0.8",
       .example = "0.8",
       .description = "fraction of the estimate or bound in use"},
      {.path = "timestep.dt",
       .kind = quantity,
       .unit = "s",
       .range = positive,
       .example = "10 us",
       .description = "the timestep; needed with policy `fixed`, and only there"},

      {.path = "run",
       .kind = section,
       .example = "{steps: 10000}",
       .description = "when the explicit cycle ends: at the first of `steps`, `time` and `until`, one of "
                      "which is wanted; "
                      "absent: no run"},
      {.path = "run.steps",
       .kind = integer,
       .range = {.low = 1},
       .example = "10000",
       .description = "number of steps since the start of the scene"},
      {.path = "run.time",
       .kind = quantity,
       .unit = "s",
       .range = positive,
       .example = "2 s",
       .description = "time since the start of the scene"},
      {.path = "run.until",
       .kind = section,
       .example = "{unbalanced: 1e-5}",
       .description = "ends as soon as this holds"},
      {.path = "run.until.unbalanced",
       .kind = quantity,
       .range = positive,
       .required = true,
       .example = "1e-5",
       .description = "the mean unbalanced force ratio is below this"},

      {.path = "measures",
       .kind = section_list,
       .fallback = "[]",
       .example = "[{name: middle, sphere: {centre: [0, 0, 0.1], radius: 50 mm}}]",
       .description = "regions that `measure` and tables average over: each a sphere, a box or, without "
                      "either, all that there is"},
      {.path = "measures[].name",
       .kind = text,
       .example = "middle",
       .description = "each only once; absent: `region` and its number, from 0"},
      {.path = "measures[].sphere",
       .kind = section,
       .example = "{centre: [0, 0, 0.1], radius: 50 mm}",
       .description = "a sphere"},
      {.path = "measures[].sphere.centre",
       .kind = vector,
       .unit = "m",
       .required = true,
       .example = "[0, 0, 0.1]",
       .description = "its centre"},
      {.path = "measures[].sphere.radius",
       .kind = quantity,
       .unit = "m",
       .range = positive,
       .required = true,
       .example = "50 mm",
       .description = "its radius"},
      {.path = "measures[].box",
       .kind = section,
       .example = "{min: [0, 0, 0], max: [0.1, 0.1, 0.1]}",
       .description = "a box; where the cell repeats it may reach out of it"},
      {.path = "measures[].box.min",
       .kind = vector,
       .unit = "m",
       .required = true,
       .example = "[0, 0, 0]",
       .description = "lower corner"},
      {.path = "measures[].box.max",
       .kind = vector,
       .unit = "m",
       .required = true,
       .example = "[1, 1, 1]",
       .description = "upper corner"},

      {.path = "histories",
       .kind = section_list,
       .fallback = "[]",
       .example = "[{file: energies.csv, every: 100, of: [energies]}]",
       .description = "tables that a run writes; each wants `of`, `balls` or `measures`"},
      {.path = "histories[].file",
       .kind = text,
       .required = true,
       .example = "energies.csv",
       .description = "a name that ends in .csv, in the folder of results, each only once"},
      {.path = "histories[].every",
       .kind = integer,
       .range = {.low = 1},
       .fallback = "1",
       .example = "100",
       .description = "steps from one line to the next"},
      {.path = "histories[].of",
       .kind = words,
       .fallback = "[]",
       .words = {"energies", "unbalanced", "walls", "ledger"},
       .example = "[energies, unbalanced]",
       .description =
           "columns: kinetic, elastic and gravitational energy; mean and maximum of the unbalanced "
           "force ratio; force on each wall; the ledger of energy"},
      {.path = "histories[].balls",
       .kind = integers,
       .range = {.low = 0},
       .fallback = "[]",
       .example = "[0]",
       .description = "columns: position, velocity and spin of the balls of these numbers"},
      {.path = "histories[].measures",
       .kind = texts,
       .fallback = "[]",
       .example = "[middle]",
       .description = "columns: porosity, coordination, stress, strain rate and fabric of these regions, by "
                      "their names in `measures`"},

      {.path = "outputs",
       .kind = section,
       .example = "{checkpoint: 10000, series: 1000}",
       .description = "what else a run writes"},
      {.path = "outputs.checkpoint",
       .kind = integer,
       .range = {.low = 1},
       .fallback = "10000",
       .example = "10000",
       .description = "steps from one checkpoint, from which the run can go on, to the next"},
      {.path = "outputs.series",
       .kind = integer,
       .range = {.low = 1},
       .example = "1000",
       .description = "steps from one frame for ParaView to the next; absent: none"},
      {.path = "outputs.fields",
       .kind = words,
       .fallback = "[]",
       .words = {"stress"},
       .example = "[stress]",
       .description = "what frames say beyond the usual: the mean stress of each ball"},
  };
}

KeyDescription law_key(const contact::LawDescription& law, const contact::ParameterDescription& parameter) {
  const bool is_flag = parameter.kind == contact::ParameterDescription::Kind::flag;
  KeyDescription key{.path = fmt::format("contacts[].{}", parameter.name), .kind = is_flag ? flag : quantity};
  key.law = law.name;
  key.unit = parameter.unit;
  key.description = parameter.description;
  key.required = !parameter.default_value.has_value();
  if (is_flag) {
    if (!key.required) key.fallback = *parameter.default_value != 0 ? "true" : "false";
    key.example = "true";
    return key;
  }
  key.range = {.low = parameter.minimum, .low_allowed = parameter.minimum_allowed};
  if (!key.required) key.fallback = fmt::format("{}", *parameter.default_value);
  const double valid = parameter.minimum > -infinity ? parameter.minimum + 1 : 1;
  key.example = key.unit.empty() ? fmt::format("{}", valid) : fmt::format("{} {}", valid, key.unit);
  return key;
}

std::vector<KeyDescription> all_keys() {
  std::vector<KeyDescription> keys = own_keys();
  std::vector<KeyDescription> of_laws;
  for (const contact::LawDescription& law : contact::law_descriptions())
    for (const contact::ParameterDescription& parameter : law.parameters)
      of_laws.push_back(law_key(law, parameter));
  // A section's keys stand together: the laws' come behind the last of the contacts'.
  const auto behind = std::find_if(keys.begin(), keys.end(), [](const auto& k) { return k.path == "balls"; });
  keys.insert(behind, of_laws.begin(), of_laws.end());
  return keys;
}

}  // namespace

bool Range::contains(double value) const {
  const bool above = low_allowed ? value >= low : value > low;
  const bool below = high_allowed ? value <= high : value < high;
  return above && below;
}

std::string Range::text() const {
  const std::string above = low > -infinity ? fmt::format("{} {}", low_allowed ? ">=" : ">", low) : "";
  const std::string below = high < infinity ? fmt::format("{} {}", high_allowed ? "<=" : "<", high) : "";
  return above.empty() || below.empty() ? above + below : above + " and " + below;
}

std::string_view KeyDescription::name() const {
  const std::string_view all = path;
  return all.substr(all.rfind('.') + 1);
}

std::string_view KeyDescription::section() const {
  const std::size_t dot = path.rfind('.');
  return dot == std::string::npos ? std::string_view() : std::string_view(path).substr(0, dot);
}

std::vector<std::string> law_names() {
  std::vector<std::string> names;
  for (const contact::LawDescription& law : contact::law_descriptions()) names.emplace_back(law.name);
  names.emplace_back("none");
  return names;
}

const std::vector<KeyDescription>& scene_schema() {
  static const std::vector<KeyDescription> keys = all_keys();
  return keys;
}

std::vector<const KeyDescription*> section_keys(std::string_view section, std::string_view law) {
  std::vector<const KeyDescription*> keys;
  for (const KeyDescription& key : scene_schema())
    if (key.section() == section && (law.empty() || key.law.empty() || key.law == law)) keys.push_back(&key);
  return keys;
}

}  // namespace eigengrain::io
