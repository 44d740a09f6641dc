#include "eigengrain/assembly/linear_system.hpp"
#include "eigengrain/base/error.hpp"
#include "eigengrain/io/mode_file.hpp"
#include "eigengrain/petsc/session.hpp"
#include "eigengrain/spectrum/density.hpp"
#include "eigengrain/spectrum/modes.hpp"

#include "input.hpp"
#include "interrupt.hpp"
#include "text.hpp"
#include "verbs.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <vector>

namespace eigengrain::app {
namespace {

using assembly::LinearSystem;
using nlohmann::ordered_json;
using spectrum::Character;
using spectrum::Density;
using spectrum::Modes;

ordered_json to_json(const LinearSystem& system, const Modes& modes) {
  ordered_json all = ordered_json::array();
  for (std::size_t k = 0; k < modes.lambda.size(); ++k) {
    const Character character = spectrum::character_of(system, modes.shape[k]);
    all.push_back({{"lambda", modes.lambda[k]},
                   {"omega", std::sqrt(modes.lambda[k])},
                   {"residual", modes.residual[k]},
                   {"participation", character.participation},
                   {"translation", character.translation}});
  }
  return all;
}

void print(const char* which, const ordered_json& modes) {
  if (modes.empty()) return;
  fmt::print("{} modes: angular frequency (rad/s), participation ratio, share of translations\n", which);
  for (const ordered_json& mode : modes)
    fmt::print("  {:14.7g}  {:8.4f}  {:8.4f}\n", mode["omega"].get<double>(),
               mode["participation"].get<double>(), mode["translation"].get<double>());
}

ordered_json to_json(const Density& density) {
  return {{"edges", density.edge},     {"count", density.count},
          {"error", density.error},    {"resolution", density.resolution},
          {"modes", density.modes},    {"products", density.products},
          {"seconds", density.seconds}};
}

void print(const Density& density) {
  fmt::print("density of states: {} modes, each smeared over {:.3g} rad/s, {} products with K in {:.1f} s\n",
             density.modes, density.resolution, density.products, density.seconds);
  fmt::print("  from (rad/s)      modes  +-\n");
  for (std::size_t k = 0; k < density.count.size(); ++k)
    fmt::print("  {:12.5g}  {:9.2f}  {:.2g}\n", density.edge[k], density.count[k], density.error[k]);
}

void write_shapes(const assembly::Model& model, const LinearSystem& system,
                  const std::vector<const Modes*>& parts, const std::string& file) {
  std::vector<spectrum::BodyMotion> motions;
  for (const Modes* modes : parts)
    for (const std::vector<double>& shape : modes->shape)
      motions.push_back(spectrum::motion_of_bodies(system, shape));
  std::vector<io::ModeShape> shapes;
  for (const spectrum::BodyMotion& motion : motions)
    shapes.push_back({motion.displacement, motion.rotation, motion.energy});
  io::write_modes(file, model.bodies, shapes);
}

}  // namespace

void modes(const Options& options) {
  if (!options.petsc.empty()) petsc::set_options(options.petsc);
  const SpectrumOptions& wanted = options.spectrum;
  const Question question = read_question(options);
  petsc::start();
  const LinearSystem system(question.model);
  ordered_json report{{"bodies", question.model.bodies.size()},
                      {"contacts", system.elements.size()},
                      {"unknowns", system.unknowns.free_components().size()}};
  if (wanted.all) {
    report["all"] = spectrum::all_modes(system, false).lambda;
    fmt::print("all {} modes; their eigenvalues are in the JSON (--json)\n", report["all"].size());
  } else {
    const Modes lowest = wanted.lowest > 0 ? spectrum::lowest_modes(system, wanted.lowest) : Modes{};
    const Modes highest = wanted.highest > 0 ? spectrum::highest_modes(system, wanted.highest) : Modes{};
    report["lowest"] = to_json(system, lowest);
    report["highest"] = to_json(system, highest);
    print("lowest", report["lowest"]);
    print("highest", report["highest"]);
    if (!options.modes_file.empty())
      write_shapes(question.model, system, {&lowest, &highest}, options.modes_file);
  }
  if (wanted.density) {
    note_interrupts();
    const Density density = spectrum::density_of_states(
        system,
        {.moments = wanted.moments, .vectors = wanted.vectors, .bins = wanted.bins, .interrupted = [] {
           return interrupted() != 0;
         }});
    report["density"] = to_json(density);
    print(density);
  }
  write_json(options.json, report);
  print_notes(question.settings);
  if (interrupted() != 0) throw Interrupted{interrupted()};
  if (!options.petsc.empty()) petsc::require_options_used();
}

}  // namespace eigengrain::app
