#include "compared_scene.hpp"

#include "eigengrain/assembly/product.hpp"
#include "eigengrain/base/error.hpp"
#include "eigengrain/base/timer.hpp"
#include "eigengrain/cycle/mass_scaling.hpp"
#include "eigengrain/cycle/policy.hpp"
#include "eigengrain/io/scene_reader.hpp"
#include "eigengrain/io/state_file.hpp"

#include "../input.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <iterator>
#include <limits>
#include <string_view>

namespace eigengrain::app {
namespace {

namespace fs = std::filesystem;

/// The policies of scene files that find a step by themselves.
constexpr std::array policies{model::TimestepPolicy::estimate, model::TimestepPolicy::bound,
                              model::TimestepPolicy::tracked};

/// The first call is that of cold caches, and machines have other things to do: the least of some counts, as
/// many as fit into this time.
constexpr double enough_time = 0.05;  // s
constexpr int most_calls = 200;
constexpr int fewest_calls = 10;  // of a product

std::vector<std::string> scenes_in(const fs::path& folder) {
  std::vector<std::string> files;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder))
    if (entry.path().extension() == ".yaml") files.push_back(entry.path().string());
  std::sort(files.begin(), files.end());
  return files;
}

/// The stem of a file with so many of its folders before it.
std::string name_of(const fs::path& file, int folders) {
  fs::path name = file.stem();
  fs::path folder = file.parent_path();
  for (int k = 0; k < folders && folder.has_filename(); ++k, folder = folder.parent_path())
    name = folder.filename() / name;
  return name.string();
}

/// Names that tell the files apart: stems, with as many of the folders as it takes.
std::vector<std::string> names_of(const std::vector<std::string>& files) {
  constexpr int most_folders = 64;
  std::vector<std::string> names(files.size());
  for (std::size_t k = 0; k < files.size(); ++k) {
    const fs::path path = fs::absolute(files[k]).lexically_normal();
    for (int folders = 0; folders < most_folders; ++folders) {
      names[k] = name_of(path, folders);
      const auto same = std::count_if(files.begin(), files.end(), [&](const std::string& other) {
        return name_of(fs::absolute(other).lexically_normal(), folders) == names[k];
      });
      if (same == 1) break;
    }
  }
  return names;
}

Options options_for(const Options& options, const std::string& file) {
  Options of_scene = options;
  of_scene.scene = file;
  return of_scene;
}

/// Reads everything once for its mistakes alone, so that nobody waits for an hour to hear of the last
/// scene's.
void check_all(const std::vector<std::string>& files, const Options& options) {
  std::vector<Mistake> mistakes;
  for (const std::string& file : files) {
    if (io::is_state_file(file)) continue;
    try {
      io::read_scene(file, options.overrides);
    } catch (const InputError& error) {
      mistakes.insert(mistakes.end(), error.mistakes().begin(), error.mistakes().end());
    }
  }
  if (!mistakes.empty()) throw InputError(std::move(mistakes));
}

std::vector<PolicyStep> steps_of_policies(const assembly::State& state, double limit) {
  std::vector<PolicyStep> steps;
  if (state.settings.mass_scaling) return steps;  // masses follow the step there, not the other way round
  for (const model::TimestepPolicy policy : policies) {
    model::Scene settings = state.settings;
    settings.timestep = {.policy = policy, .safety = model::default_safety(policy), .dt = {}};
    const double dt = cycle::policy_of(settings).dt(state);
    steps.push_back({std::string(model::name_of(policy)), dt, dt <= limit});
  }
  return steps;
}

void compare(const Options& options, ComparedScene& scene) {
  assembly::State state = read_input(options).state;
  if (state.settings.mass_scaling && state.next_dt == 0) cycle::scale_masses(state);
  const assembly::LinearSystem system(state.model);
  if (system.unknowns.free_components().empty() || system.elements.empty()) {
    scene.skipped = "nothing touches that could move, so no step is critical";
    return;
  }
  scene.comparison = timestep::compare(state.model, {}, state.settings.materials);
  if (!std::isfinite(scene.comparison.truth.dt)) {
    scene.skipped = "nothing resists a motion, so no step is critical";
    return;
  }
  scene.product_seconds = seconds_of_product(system);
  measure_again({state.model, system, state.settings.materials}, scene.comparison);
  scene.policies = steps_of_policies(state, scene.comparison.truth.limit);
}

}  // namespace

std::vector<std::string> files_of(const std::vector<std::string>& arguments) {
  std::vector<std::string> files;
  std::vector<Mistake> mistakes;
  for (const std::string& argument : arguments) {
    if (!fs::is_directory(argument)) {
      if (fs::exists(argument))
        files.push_back(argument);
      else
        mistakes.push_back({argument, 0, "there is no such file or folder"});
      continue;
    }
    const std::vector<std::string> found = scenes_in(argument);
    if (found.empty())
      mistakes.push_back(
          {argument, 0, "no scene (*.yaml) in this folder; name one that holds some, or a scene"});
    files.insert(files.end(), found.begin(), found.end());
  }
  if (!mistakes.empty()) throw InputError(std::move(mistakes));
  return files;
}

std::vector<ComparedScene> compare_scenes(const Options& options) {
  const std::vector<std::string> files = files_of(options.scenes);
  check_all(files, options);
  const std::vector<std::string> names = names_of(files);
  std::vector<ComparedScene> scenes;
  for (std::size_t k = 0; k < files.size(); ++k) {
    ComparedScene& scene = scenes.emplace_back(ComparedScene{.name = names[k], .file = files[k]});
    const Stopwatch watch;
    try {
      compare(options_for(options, files[k]), scene);
    } catch (const SolverError& error) {
      scene.skipped = error.what();
    } catch (const InputError& error) {  // a damaged state must not cost what was computed before it
      scene.skipped = error.what();
    }
    if (files.size() > 1)
      fmt::print(stderr, "{}/{} {}: {}\n", k + 1, files.size(), scene.name,
                 scene.skipped.empty() ? fmt::format("{:.2g} s", watch.seconds()) : scene.skipped);
  }
  return scenes;
}

void measure_again(const timestep::Question& question, timestep::Comparison& comparison) {
  for (timestep::Estimate& estimate : comparison.estimates) {
    const timestep::Estimator* estimator = timestep::find_estimator(estimate.name);
    double total = estimate.seconds;
    for (int k = 0; k < most_calls && total < enough_time; ++k) {
      const Stopwatch watch;
      estimator->find(question);
      const double seconds = watch.seconds();
      estimate.seconds = std::min(estimate.seconds, seconds);
      total += seconds;
    }
  }
}

double seconds_of_product(const assembly::LinearSystem& system) {
  assembly::StiffnessProduct product(system.unknowns, system.parts(), system.inverse_sqrt_mass());
  const auto n = static_cast<std::size_t>(product.size());
  std::vector<double> x(n, 1.0);
  std::vector<double> y(n);
  product.apply(x, y);  // pages and caches
  double least = std::numeric_limits<double>::infinity();
  double total = 0;
  for (int k = 0; k < most_calls && (total < enough_time || k < fewest_calls); ++k) {
    const Stopwatch watch;
    product.apply(x, y);
    const double seconds = watch.seconds();
    least = std::min(least, seconds);
    total += seconds;
  }
  return least;
}

}  // namespace eigengrain::app
