#include "input.hpp"

#include "eigengrain/cycle/cycle.hpp"
#include "eigengrain/io/scene_reader.hpp"
#include "eigengrain/io/state_file.hpp"

#include <utility>

namespace eigengrain::app {

Input read_input(const Options& options) {
  const std::filesystem::path file = options.scene;
  Input input;
  input.stem = file.stem().string();
  input.continued = io::is_state_file(file);
  input.folder = !options.output.empty() ? std::filesystem::path(options.output)
                 : input.continued       ? file.parent_path()
                                         : std::filesystem::path();
  if (input.folder.empty()) input.folder = ".";
  input.state = input.continued ? io::read_state(file, options.overrides)
                                : cycle::start(io::read_scene(file, options.overrides));
  // An override may have changed what the step rests upon; without one it goes on to the bit.
  if (input.continued && !options.overrides.empty()) input.state.next_dt = 0;
  return input;
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
