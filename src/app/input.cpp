#include "input.hpp"

#include "eigengrain/base/error.hpp"
#include "eigengrain/cycle/cycle.hpp"
#include "eigengrain/io/scene_reader.hpp"
#include "eigengrain/io/state_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <system_error>
#include <utility>

namespace eigengrain::app {
namespace {

/// Whether an override may change what the step rests upon, so that it has to be chosen anew. Without one, a
/// run goes on with the step that it had, to the bit.
bool touches_the_step(const std::string& override_text) {
  constexpr std::array<std::string_view, 5> harmless{"run", "outputs", "histories", "measures", "stages"};
  return std::none_of(harmless.begin(), harmless.end(),
                      [&](std::string_view key) { return override_text.starts_with(key); });
}

/// Whether an override may change the energy of a state.
bool touches_the_energy(const std::string& override_text) {
  return touches_the_step(override_text) && !override_text.starts_with("timestep") &&
         !override_text.starts_with("damping");
}

void make_folder(const std::filesystem::path& folder) {
  std::error_code problem;
  std::filesystem::create_directories(folder, problem);
  if (problem)
    throw InputError(fmt::format("--output {}: the folder cannot be made ({}); name one that can be written",
                                 folder.string(), problem.message()));
}

}  // namespace

Input read_input(const Options& options) {
  const std::filesystem::path file = options.scene;
  Input input;
  input.stem = file.stem().string();
  input.continued = io::is_state_file(file);
  input.folder = !options.output.empty() ? std::filesystem::path(options.output)
                 : input.continued       ? file.parent_path()
                                         : std::filesystem::path();
  if (input.folder.empty()) input.folder = ".";
  if (!options.output.empty()) make_folder(input.folder);
  input.state = input.continued ? io::read_state(file, options.overrides)
                                : cycle::start(io::read_scene(file, options.overrides));
  if (input.continued) adapt_to(options.overrides, input.state);
  return input;
}

void adapt_to(std::span<const std::string> overrides, assembly::State& state) {
  if (std::any_of(overrides.begin(), overrides.end(), touches_the_step)) assembly::forget_step(state);
  if (state.ledger && std::any_of(overrides.begin(), overrides.end(), touches_the_energy)) {
    state.ledger.reset();
    state.settings.notes.emplace_back(
        "with other settings the scene has another energy: the ledger begins anew");
  }
}

Question read_question(const Options& options) {
  if (io::is_state_file(options.scene)) {
    assembly::State state = io::read_state(options.scene, options.overrides);
    return {std::move(state.settings), std::move(state.model)};
  }
  model::Scene scene = io::read_scene(options.scene, options.overrides);
  assembly::Model model = assembly::build_model(scene);
  return {std::move(scene), std::move(model)};
}

}  // namespace eigengrain::app
