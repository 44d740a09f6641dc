#include "eigengrain/io/schema.hpp"

#include "eigengrain/contact/law_table.hpp"
#include "eigengrain/generate/lattice.hpp"

#include "packing_format.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace eigengrain::io {
namespace {

using enum KeyKind;

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr Range positive{.low = 0, .low_allowed = false};

std::vector<std::string> lattice_names() {
  std::vector<std::string> names;
  for (const generate::Lattice& lattice : generate::lattices()) names.emplace_back(lattice.name);
  return names;
}

/// Everything but the parameters of the laws and bonds. The description says what the reader does with the
/// value.
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
      {.path = "materials[].young",
       .kind = quantity,
       .unit = "Pa",
       .range = positive,
       .example = "70 GPa",
       .description = "Young's modulus, for laws that compute their parameters from it"},
      {.path = "materials[].poisson",
       .kind = quantity,
       .range = {.low = -1, .high = 0.5, .low_allowed = false},
       .example = "0.3",
       .description = "Poisson's ratio, beside `young`"},
      {.path = "materials[].kn",
       .kind = quantity,
       .unit = "N/m",
       .range = positive,
       .example = "2e5 N/m",
       .description =
           "normal stiffness of one side of a contact, in series with that of the other, where the "
           "entry of `contacts` leaves `kn` out"},
      {.path = "materials[].ks",
       .kind = quantity,
       .unit = "N/m",
       .range = {.low = 0},
       .example = "1e5 N/m",
       .description = "the same for `ks`"},
      {.path = "materials[].rigid",
       .kind = flag,
       .fallback = "false",
       .example = "true",
       .description =
           "does not give in a contact: only the other side does; stands for `young`, `poisson`, `kn` "
           "and `ks`"},

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

      {.path = "contacts[].bond",
       .kind = section,
       .example = "{kind: parallel, kn: 1e12 Pa/m, tension: 5 MPa, gap: 10 um}",
       .description = "bonds between the balls of these pairs, made when the scene starts; absent: none"},
      {.path = "contacts[].bond.kind",
       .kind = word,
       .required = true,
       .words = bond_names(),
       .example = "parallel",
       .description = "the kind of bond, see below"},
      {.path = "contacts[].bond.gap",
       .kind = quantity,
       .unit = "m",
       .range = {.low = 0},
       .fallback = "0",
       .example = "10 um",
       .description = "pairs of balls whose surfaces are no more than this apart are bonded; rounding of "
                      "positions may set balls that should touch a little apart"},

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
       .range = positive,
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
       .range = positive,
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
       .range = positive,
       .example = "4 mm",
       .description = "least radius; default of `normal`: mean - 3 deviations"},
      {.path = "balls[].sizes.max",
       .kind = quantity,
       .unit = "m",
       .range = positive,
       .example = "6 mm",
       .description = "largest radius; default of `normal`: mean + 3 deviations"},
      {.path = "balls[].sizes.mean",
       .kind = quantity,
       .unit = "m",
       .range = positive,
       .example = "5 mm",
       .description = "of the radius, before `min` and `max` cut"},
      {.path = "balls[].sizes.deviation",
       .kind = quantity,
       .unit = "m",
       .range = positive,
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
       .range = positive,
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

      {.path = "walls",
       .kind = section_list,
       .fallback = "[]",
       .example = "[{plane: {point: [0, 0, 0], normal: [0, 0, 1]}, material: grain}]",
       .description = "each entry is a plane, a box, a polygon or a mesh; all balls must lie on the active "
                      "side of planes"},
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
      {.path = "walls[].polygon",
       .kind = section,
       .example = "{corners: [[0, 0, 0], [1, 0, 0], [0, 1, 0]]}",
       .description = "a convex polygon"},
      {.path = "walls[].polygon.corners",
       .kind = vectors,
       .unit = "m",
       .required = true,
       .example = "[[0, 0, 0], [1, 0, 0], [0, 1, 0]]",
       .description = "in their order, counter-clockwise seen from the active side; in one plane"},
      {.path = "walls[].polygon.two_sided",
       .kind = flag,
       .fallback = "false",
       .example = "true",
       .description = "whether both sides are active"},
      {.path = "walls[].mesh",
       .kind = section,
       .example = "{file: drum.stl, unit: mm}",
       .description = "a surface of triangles"},
      {.path = "walls[].mesh.file",
       .kind = text,
       .required = true,
       .example = "drum.stl",
       .description = "STL (text or binary) or OBJ, by its ending; the path is relative to the scene file. "
                      "Normals, by the order of the corners, point to the active side"},
      {.path = "walls[].mesh.unit",
       .kind = word,
       .required = true,
       .words = {"m", "cm", "mm", "um"},
       .example = "mm",
       .description = "of the lengths in the file, which does not say it"},
      {.path = "walls[].mesh.two_sided",
       .kind = flag,
       .fallback = "false",
       .example = "true",
       .description = "whether both sides are active"},
      {.path = "walls[].material",
       .kind = text,
       .required = true,
       .example = "grain",
       .description = "a name out of `materials`"},
      {.path = "walls[].velocity",
       .kind = vector,
       .unit = "m/s",
       .fallback = "[0, 0, 0]",
       .example = "[0, 0, -10 mm/s]",
       .description = "of the wall's centre, constant"},
      {.path = "walls[].spin",
       .kind = vector,
       .unit = "rad/s",
       .fallback = "[0, 0, 0]",
       .example = "[0, 0.5, 0]",
       .description = "angular velocity about the centre, constant"},
      {.path = "walls[].centre",
       .kind = vector,
       .unit = "m",
       .example = "[0, 0, 0]",
       .description =
           "about which the wall turns and moments on it are taken, at the start; absent: the point "
           "of a plane, the middle of a box, the mean of the corners of a polygon or mesh"},
      {.path = "walls[].motion",
       .kind = section_list,
       .example = "[{time: 0, velocity: [0, 0, 0]}, {time: 0.1, velocity: [0, 0, -0.5]}]",
       .description = "velocities at given times instead, linear in between, constant before and after"},
      {.path = "walls[].motion[].time",
       .kind = quantity,
       .unit = "s",
       .required = true,
       .example = "100 ms",
       .description = "since the start of the scene; above that of the entry before"},
      {.path = "walls[].motion[].velocity",
       .kind = vector,
       .unit = "m/s",
       .fallback = "[0, 0, 0]",
       .example = "[0, 0, -0.5]",
       .description = "of the wall's centre at that time"},
      {.path = "walls[].motion[].spin",
       .kind = vector,
       .unit = "rad/s",
       .fallback = "[0, 0, 0]",
       .example = "[0, 0.5, 0]",
       .description = "angular velocity about the centre at that time"},
      {.path = "walls[].servo",
       .kind = section,
       .example = "{force: 10 N, max_speed: 0.1}",
       .description = "moves the wall until it pushes with a force, in addition to its velocity"},
      {.path = "walls[].servo.direction",
       .kind = vector,
       .example = "[0, 0, -1]",
       .description = "in which the wall pushes, of any length but zero; absent: the normal of a plane, of "
                      "each side of a box, of a polygon"},
      {.path = "walls[].servo.force",
       .kind = quantity,
       .unit = "N",
       .range = positive,
       .example = "10 N",
       .description = "of the wall on the balls along `direction`; this or `stress`"},
      {.path = "walls[].servo.stress",
       .kind = quantity,
       .unit = "Pa",
       .range = positive,
       .example = "100 kPa",
       .description = "force over `area`"},
      {.path = "walls[].servo.area",
       .kind = quantity,
       .unit = "m2",
       .range = positive,
       .example = "0.04 m2",
       .description =
           "that `stress` acts on; absent: that of a side of a box, or of a polygon, at the start"},
      {.path = "walls[].servo.relaxation",
       .kind = quantity,
       .range = {.low = 0, .high = 1, .low_allowed = false},
       .fallback = "0.5",
       .example = "0.5",
       .description = "part of the missing force that a step makes up for while the balls stand still"},
      {.path = "walls[].servo.max_speed",
       .kind = quantity,
       .unit = "m/s",
       .range = positive,
       .required = true,
       .example = "0.1 m/s",
       .description = "bound of the speed; the speed while nothing touches the wall"},
      {.path = "walls[].motion_file",
       .kind = text,
       .example = "motion.csv",
       .description = "the same from a file, `time, vx, vy, vz` or `time, vx, vy, vz, wx, wy, wz` a line, in "
                      "s, m/s, rad/s; `#` starts a comment; the path is relative to the scene file"},

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

      {.path = "histories",
       .kind = section_list,
       .fallback = "[]",
       .example = "[{file: energies.csv, every: 100, of: [energies]}]",
       .description = "tables that a run writes; each wants `of`, `balls` or both"},
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
       .words = {"energies", "unbalanced", "walls", "wall_moments", "wall_positions"},
       .example = "[energies, unbalanced]",
       .description =
           "columns: kinetic, elastic and gravitational energy; mean and maximum of the unbalanced "
           "force ratio; force on each wall; moment on each wall about its centre; centre of each wall"},
      {.path = "histories[].balls",
       .kind = integers,
       .range = {.low = 0},
       .fallback = "[]",
       .example = "[0]",
       .description = "columns: position, velocity and spin of the balls of these numbers"},

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
  };
}

/// section  that the parameter stands in: of a contact or of its bond
KeyDescription law_key(std::string_view section, const contact::LawDescription& law,
                       const contact::ParameterDescription& parameter) {
  const bool is_flag = parameter.kind == contact::ParameterDescription::Kind::flag;
  KeyDescription key{.path = fmt::format("{}.{}", section, parameter.name),
                     .kind = is_flag ? flag : quantity};
  key.law = law.name;
  key.unit = parameter.unit;
  key.description = parameter.description;
  key.from_materials = parameter.of_material != nullptr ? parameter.material_keys : "";
  key.required = !parameter.default_value.has_value() && parameter.of_material == nullptr;
  if (is_flag) {
    if (!key.required) key.fallback = *parameter.default_value != 0 ? "true" : "false";
    key.example = "true";
    return key;
  }
  key.range = {.low = parameter.minimum, .high = parameter.maximum, .low_allowed = parameter.minimum_allowed};
  // A default without bound is that of a key that is left out; no number says it.
  if (parameter.default_value && *parameter.default_value < infinity)
    key.fallback = fmt::format("{}", *parameter.default_value);
  const double valid = parameter.minimum > -infinity ? parameter.minimum + 1 : 1;
  key.example = key.unit.empty() ? fmt::format("{}", valid) : fmt::format("{} {}", valid, key.unit);
  return key;
}

std::vector<KeyDescription> all_keys() {
  std::vector<KeyDescription> keys = own_keys();
  std::vector<KeyDescription> of_laws;
  for (const contact::LawDescription& law : contact::law_descriptions())
    for (const contact::ParameterDescription& parameter : law.parameters)
      of_laws.push_back(law_key("contacts[]", law, parameter));
  for (const contact::LawDescription& bond : contact::bond_descriptions())
    for (const contact::ParameterDescription& parameter : bond.parameters)
      of_laws.push_back(law_key("contacts[].bond", bond, parameter));
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

std::vector<std::string> bond_names() {
  std::vector<std::string> names;
  for (const contact::LawDescription& bond : contact::bond_descriptions()) names.emplace_back(bond.name);
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
