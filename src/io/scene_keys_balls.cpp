#include "eigengrain/generate/lattice.hpp"

#include "packing_format.hpp"
#include "scene_keys.hpp"

namespace eigengrain::io {

using enum KeyKind;

namespace {

std::vector<std::string> lattice_names() {
  std::vector<std::string> names;
  for (const generate::Lattice& lattice : generate::lattices()) names.emplace_back(lattice.name);
  return names;
}

}  // namespace

std::vector<KeyDescription> ball_keys() {
  return {
      {.path = "planar",
       .kind = section,
       .example = "{shape: disk, normal: z}",
       .description =
           "a scene in a plane: bodies keep their place across it and turn about its normal alone, "
           "so each has three unknowns"},
      {.path = "planar.shape",
       .kind = word,
       .fallback = "sphere",
       .words = {"sphere", "disk"},
       .example = "disk",
       .description = "what balls are, for their masses: spheres, or disks of unit thickness (1 m)"},
      {.path = "planar.normal",
       .kind = word,
       .fallback = "z",
       .words = {"x", "y", "z"},
       .example = "y",
       .description = "the axis across the plane"},

      {.path = "balls",
       .kind = section_list,
       .required = true,
       .example = "[{position: [0, 0, 0], radius: 5 mm, material: grain}]",
       .description =
           "each entry is a packing file, one ball, or balls that are made; balls are numbered from 0 in "
           "this order"},
      {.path = "balls[].file",
       .kind = text,
       .example = "packing.txt",
       .description =
           "a packing: `x y z r` a line, in m, `#` starts a comment; or what LAMMPS or YADE write; the path "
           "is relative to the scene file"},
      {.path = "balls[].format",
       .kind = word,
       .words = packing_format_names(),
       .example = "packing",
       .description =
           "of `file`; absent: what its text looks like. `lammps-data`: write_data of atom_style sphere; "
           "`lammps-dump`: the last frame, with columns x y z radius; `yade-text`: export.text, "
           "export.textExt"},
      {.path = "balls[].position",
       .kind = vector,
       .unit = "m",
       .example = "[10 mm, 0, 0.3]",
       .description = "centre of one ball; wrapped into the cell where that is periodic"},
      {.path = "balls[].radius",
       .kind = quantity,
       .unit = "m",
       .range = positive_range,
       .example = "5 mm",
       .description = "needed with `position` and `lattice`; with `fill`, this or `sizes`"},
      {.path = "balls[].lattice",
       .kind = word,
       .words = lattice_names(),
       .example = "fcc",
       .description =
           "equal balls on the sites of a lattice; `square` and `hexagonal` are one layer midway between the "
           "faces in z"},
      {.path = "balls[].spacing",
       .kind = quantity,
       .unit = "m",
       .range = positive_range,
       .example = "10 mm",
       .description = "of a lattice: distance of nearest neighbours; absent: they touch"},
      {.path = "balls[].overlap",
       .kind = quantity,
       .unit = "m",
       .range = {.low = 0},
       .example = "10 um",
       .description = "of a lattice, instead of `spacing`: how far nearest neighbours overlap"},
      {.path = "balls[].fill",
       .kind = word,
       .words = {"random", "dense"},
       .example = "random",
       .description =
           "balls at random places: `random` puts one after the other where it overlaps none, up to a "
           "fraction "
           "of about 0.3; `dense` pushes overlapping balls apart, and where they jam into equilibrium "
           "without friction"},
      {.path = "balls[].fraction",
       .kind = quantity,
       .range = {.low = 0, .high = 1, .low_allowed = false, .high_allowed = false},
       .example = "0.3",
       .description = "of `fill`: volume of the balls over that of the region; reached to half a ball"},
      {.path = "balls[].mean_overlap",
       .kind = quantity,
       .range = {.low = 0, .high = 0.05, .low_allowed = false},
       .example = "1e-3",
       .description = "of `fill: dense`, instead of `fraction`: mean overlap of the contacts, as a part of "
                      "r_a + r_b; all "
                      "radii are multiplied by one factor to reach it within 1%"},
      {.path = "balls[].seed",
       .kind = integer,
       .range = {.low = 0},
       .fallback = "1",
       .example = "1",
       .description = "of `fill`: another one gives other balls"},
      {.path = "balls[].sizes",
       .kind = section,
       .example = "{distribution: uniform, min: 4 mm, max: 6 mm}",
       .description = "of `fill`, instead of `radius`: a distribution of radii, by number"},
      {.path = "balls[].sizes.distribution",
       .kind = word,
       .required = true,
       .words = {"uniform", "normal", "lognormal", "power", "table"},
       .example = "uniform",
       .description =
           "`uniform`: `min`, `max`; `normal`, `lognormal`: `mean`, `deviation`, cut to `min`, `max`; "
           "`power`: "
           "density r^`exponent` from `min` to `max`; `table`: `radii` with `shares` or `passing`"},
      {.path = "balls[].sizes.min",
       .kind = quantity,
       .unit = "m",
       .range = positive_range,
       .example = "4 mm",
       .description = "least radius; default of `normal`: mean - 3 deviations"},
      {.path = "balls[].sizes.max",
       .kind = quantity,
       .unit = "m",
       .range = positive_range,
       .example = "6 mm",
       .description = "largest radius; default of `normal`: mean + 3 deviations"},
      {.path = "balls[].sizes.mean",
       .kind = quantity,
       .unit = "m",
       .range = positive_range,
       .example = "5 mm",
       .description = "of the radius, before `min` and `max` cut"},
      {.path = "balls[].sizes.deviation",
       .kind = quantity,
       .unit = "m",
       .range = positive_range,
       .example = "0.5 mm",
       .description = "standard deviation of the radius, before `min` and `max` cut"},
      {.path = "balls[].sizes.exponent",
       .kind = quantity,
       .range = {.low = -20, .high = 20},
       .example = "-3",
       .description = "of a `power`"},
      {.path = "balls[].sizes.radii",
       .kind = quantities,
       .unit = "m",
       .range = positive_range,
       .example = "[4 mm, 6 mm]",
       .description = "of a `table`"},
      {.path = "balls[].sizes.shares",
       .kind = quantities,
       .range = {.low = 0},
       .example = "[0.3, 0.7]",
       .description = "one for each of `radii`; their sum need not be 1"},
      {.path = "balls[].sizes.passing",
       .kind = quantities,
       .range = {.low = 0, .high = 1},
       .example = "[0, 1]",
       .description =
           "instead of `shares`: the part that is smaller than each of `radii`, from 0 to 1, evenly spread "
           "between two"},
      {.path = "balls[].sizes.by",
       .kind = word,
       .fallback = "number",
       .words = {"number", "mass"},
       .example = "mass",
       .description = "what `shares` and `passing` count"},
      {.path = "balls[].box",
       .kind = section,
       .example = "{min: [0, 0, 0], max: [0.1, 0.1, 0.1]}",
       .description =
           "where balls are made: wholly inside, but where the box spans the periodic cell they repeat with "
           "it; absent: the periodic cell"},
      {.path = "balls[].box.min",
       .kind = vector,
       .unit = "m",
       .required = true,
       .example = "[0, 0, 0]",
       .description = "lower corner"},
      {.path = "balls[].box.max",
       .kind = vector,
       .unit = "m",
       .required = true,
       .example = "[0.1, 0.1, 0.1]",
       .description = "upper corner"},
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
  };
}

}  // namespace eigengrain::io
