#include "eigengrain/petsc/session.hpp"
#include "eigengrain/spectrum/moduli.hpp"

#include "input.hpp"
#include "text.hpp"
#include "verbs.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>

namespace eigengrain::app {
namespace {

nlohmann::ordered_json rows(const Mat6& tensor) {
  nlohmann::ordered_json all = nlohmann::ordered_json::array();
  for (int i = 0; i < 6; ++i)
    all.push_back({tensor(i, 0), tensor(i, 1), tensor(i, 2), tensor(i, 3), tensor(i, 4), tensor(i, 5)});
  return all;
}

void print(const char* name, const Mat6& tensor) {
  fmt::print("{}, Pa (xx, yy, zz, yz, xz, xy)\n", name);
  for (int i = 0; i < 6; ++i) {
    for (int j = 0; j < 6; ++j) fmt::print("{:13.5g}", tensor(i, j));
    fmt::print("\n");
  }
}

}  // namespace

void moduli(const Options& options) {
  const Question question = read_question(options);
  petsc::start();  // before the clock
  const spectrum::Moduli found = spectrum::elastic_moduli(question.model);
  write_json(options.json, {{"bodies", question.model.bodies.size()},
                            {"contacts", found.contacts},
                            {"volume", found.volume},
                            {"stiffness", rows(found.stiffness)},
                            {"affine", rows(found.affine)},
                            {"bulk", found.bulk()},
                            {"shear", found.shear()},
                            {"residual", *std::ranges::max_element(found.residual)},
                            {"iterations", found.iterations},
                            {"seconds", found.seconds}});
  print("elastic stiffness", found.stiffness);
  print("of bodies that follow the strain", found.affine);
  fmt::print("bulk modulus {:.6g} Pa, shear modulus {:.6g} Pa (means over directions), {} in {:.6g} m3\n",
             found.bulk(), found.shear(), counted(found.contacts, "contact", "contacts"), found.volume);
  print_notes(question.settings);
}

}  // namespace eigengrain::app
