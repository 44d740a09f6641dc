// Two balls pressed together, with a normal spring only: the bound and the true critical timestep, against
// their closed forms.
#include "eigengrain/assembly/linear_system.hpp"
#include "eigengrain/assembly/unknowns.hpp"
#include "eigengrain/base/error.hpp"
#include "eigengrain/cycle/bounds.hpp"
#include "eigengrain/io/scene_reader.hpp"
#include "eigengrain/io/state_file.hpp"
#ifdef WITH_SOLVERS
#include "eigengrain/petsc/session.hpp"
#include "eigengrain/timestep/truth.hpp"
#endif

#include <cmath>
#include <cstdio>

namespace {

using namespace eigengrain;

constexpr double radius = 0.005;   // m
constexpr double density = 2500;   // kg/m³
constexpr double stiffness = 1e5;  // N/m

/// Two balls of one size that overlap by a hundredth of their radius.
model::Scene two_balls() {
  model::Scene scene;
  scene.materials = {{.name = "grain", .density = density}};
  scene.contacts = {
      {.law = "linear", .parameters = {stiffness, 0, 0, 0, 0, 0}}};  // kn; no shear, no friction
  model::Bodies& bodies = scene.bodies;
  const double mass = model::sphere_mass(radius, density);
  for (const double x : {0.0, 1.99 * radius}) {
    bodies.identity.push_back(bodies.size());
    bodies.position.emplace_back(x, 0, 0);
    bodies.radius.push_back(radius);
    bodies.mass.push_back(mass);
    bodies.inertia.push_back(model::sphere_inertia(radius, mass));
    bodies.material.push_back(0);
    bodies.fixed.emplace_back();
  }
  return scene;
}

bool agree(const char* what, double value, double expected, double tolerance) {
  std::printf("%-20s %.12e s, closed form %.12e s\n", what, value, expected);
  return std::abs(value / expected - 1) <= tolerance;
}

/// State files need HDF5: that they link is the point.
bool refuses_a_state_that_is_not_there() {
  try {
    io::read_state("nowhere.h5");
  } catch (const InputError&) {
    return true;
  }
  return false;
}

}  // namespace

int main() {
  const assembly::LinearSystem system(assembly::build_model(two_balls()));

  // λ_max of K = k [1 -1; -1 1] with mass m each is 2k/m; for two equal bodies the bound is exact.
  const double closed_form = 2 * std::sqrt(model::sphere_mass(radius, density) / (2 * stiffness));
  bool good = agree("block bound", cycle::block_bound(system), closed_form, 1e-12);
#ifdef WITH_SOLVERS
  petsc::start();
  good = agree("true", timestep::critical_timestep(system).dt, closed_form, 1e-9) && good;
#endif
  // The scene reader needs yaml-cpp: that it links is the point.
  good = io::read_scene_text(
             "materials: [{name: grain, density: 2500 kg/m3}]\n"
             "contacts: [{between: [grain, grain], law: linear, kn: 1.0e5}]\n"
             "balls: [{position: [0, 0, 0], radius: 5 mm, material: grain}]\n",
             ".")
                 .bodies.size() == 1 &&
         good;
  good = refuses_a_state_that_is_not_there() && good;
  return good ? 0 : 1;
}
