#include "scene_keys.hpp"

namespace eigengrain::io {

using enum KeyKind;

std::vector<KeyDescription> contact_keys() {
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
       .range = positive_range,
       .example = "2500 kg/m3",
       .description = "needed where balls use the material"},
      {.path = "materials[].young",
       .kind = quantity,
       .unit = "Pa",
       .range = positive_range,
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
       .range = positive_range,
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

      {.path = "levers",
       .kind = word,
       .fallback = "contact_point",
       .words = {"contact_point", "surface"},
       .example = "surface",
       .description =
           "where the levers of balls end: at the contact point, R - U/2 from the centre; or at the "
           "ball's surface, R, as in LAMMPS and LIGGGHTS, where the moments of a contact do not balance"},

      {.path = "contacts",
       .kind = section_list,
       .example = "[{between: [any, any], law: linear, kn: 1e5 N/m}]",
       .description = "laws between materials; the first entry that matches a pair holds, and every pair "
                      "that can meet needs one"},
      {.path = "contacts[].between",
       .kind = texts,
       .example = "[any, any]",
       .description =
           "two names of materials, in any order; `any` stands for each of them; needed without `name`"},
      {.path = "contacts[].law",
       .kind = word,
       .required = true,
       .words = law_names(),
       .example = "linear",
       .description = "the contact law, see below; `none`: the two do not see each other"},

      {.path = "contacts[].name",
       .kind = text,
       .example = "soft",
       .description =
           "with a name, an entry holds for no pair by itself, only for contacts that a stage gives it"},
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
  };
}

}  // namespace eigengrain::io
