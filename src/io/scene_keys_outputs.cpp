#include "scene_keys.hpp"

namespace eigengrain::io {

using enum KeyKind;

std::vector<KeyDescription> region_keys(const std::string& section, const std::string& box) {
  const auto in = [&](const char* key) { return section + key; };
  return {
      {.path = in(".sphere"),
       .kind = KeyKind::section,
       .example = "{centre: [0, 0, 0.1], radius: 50 mm}",
       .description = "a sphere"},
      {.path = in(".sphere.centre"),
       .kind = vector,
       .unit = "m",
       .required = true,
       .example = "[0, 0, 0.1]",
       .description = "its centre"},
      {.path = in(".sphere.radius"),
       .kind = quantity,
       .unit = "m",
       .range = positive_range,
       .required = true,
       .example = "50 mm",
       .description = "its radius"},
      {.path = in(".box"),
       .kind = KeyKind::section,
       .example = "{min: [0, 0, 0], max: [0.1, 0.1, 0.1]}",
       .description = box},
      {.path = in(".box.min"),
       .kind = vector,
       .unit = "m",
       .required = true,
       .example = "[0, 0, 0]",
       .description = "lower corner"},
      {.path = in(".box.max"),
       .kind = vector,
       .unit = "m",
       .required = true,
       .example = "[1, 1, 1]",
       .description = "upper corner"},
  };
}

std::vector<KeyDescription> output_keys() {
  std::vector<KeyDescription> keys{
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
  };
  const std::vector<KeyDescription> shapes =
      region_keys("measures[]", "a box; where the cell repeats it may reach out of it");
  keys.insert(keys.end(), shapes.begin(), shapes.end());
  const std::vector<KeyDescription> files{
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
       .words = {"energies", "unbalanced", "walls", "wall_moments", "wall_positions", "ledger"},
       .example = "[energies, unbalanced]",
       .description =
           "columns: kinetic, elastic and gravitational energy; mean and maximum of the unbalanced "
           "force ratio; force on each wall; moment on each wall about its centre; centre of each wall; "
           "the ledger of energy"},
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
  keys.insert(keys.end(), files.begin(), files.end());
  return keys;
}

}  // namespace eigengrain::io
