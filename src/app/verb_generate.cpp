#include "eigengrain/assembly/loads.hpp"
#include "eigengrain/base/error.hpp"
#include "eigengrain/base/timer.hpp"
#include "eigengrain/cycle/cycle.hpp"
#include "eigengrain/io/packing_file.hpp"
#include "eigengrain/io/scene_reader.hpp"
#include "eigengrain/io/state_file.hpp"

#include "progress.hpp"
#include "text.hpp"
#include "verbs.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

namespace eigengrain::app {
namespace {

/// What balls have beside places and radii, which is all that a packing file holds.
std::vector<std::string> lost_in_a_packing(const model::Bodies& bodies) {
  std::vector<std::string> lost;
  const auto& material = bodies.material;
  if (std::any_of(material.begin(), material.end(), [&](auto m) { return m != material.front(); }))
    lost.emplace_back("materials");
  const auto& fixed = bodies.fixed;
  if (std::any_of(fixed.begin(), fixed.end(), [](auto f) { return f != model::FixedComponents(); }))
    lost.emplace_back("fixed components");
  if (!bodies.clumps.empty()) lost.emplace_back("clumps");
  if (!bodies.velocity.empty() || !bodies.spin.empty()) lost.emplace_back("velocities");
  if (assembly::has_loads(bodies)) lost.emplace_back("loads");
  if (!bodies.damping.empty()) lost.emplace_back("damping of their own");
  if (!bodies.ramp.empty()) lost.emplace_back("growth");
  return lost;
}

void write(const model::Scene& scene, const std::filesystem::path& file) {
  if (file.extension() == ".h5") return io::write_state(cycle::start(scene), file);
  std::string comment =
      fmt::format("balls of {}: x y z r, in m", std::filesystem::path(scene.name).filename().string());
  for (const std::string& note : scene.notes) comment += "\n" + note;
  io::write_packing_file(scene.bodies.position, scene.bodies.radius, comment, file);
  const std::vector<std::string> lost = lost_in_a_packing(scene.bodies);
  if (!lost.empty())
    fmt::print(
        "note: a packing holds places and radii only: {} are not in it, but would be in a state (--output "
        "NAME.h5)\n",
        fmt::join(lost, ", "));
}

}  // namespace

void generate(const Options& options) {
  if (io::is_state_file(options.scene))
    throw InputError(fmt::format(
        "{}: a state has its balls already; generate takes a scene, whose balls it makes", options.scene));
  const Stopwatch watch;
  const model::Scene scene = io::read_scene(options.scene, options.overrides);
  print_notes(scene);
  write(scene, options.output);
  const double seconds = watch.seconds();
  write_json(options.json, {{"balls", scene.bodies.size()},
                            {"file", options.output},
                            {"seconds", seconds},
                            {"notes", scene.notes}});
  fmt::print("{}: {} in {}\n", options.output, counted(scene.bodies.size(), "ball", "balls"),
             duration_text(seconds));
}

}  // namespace eigengrain::app
