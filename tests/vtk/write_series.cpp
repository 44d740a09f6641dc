// Writes two series of frames into a folder, one of them in two runs, and beside them as JSON what each frame
// must say, ball by ball in the order of identity. Usage: write_series FOLDER
#include "eigengrain/io/series.hpp"

#include "support/states.hpp"

#include <nlohmann/json.hpp>

#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <random>
#include <string>
#include <vector>

namespace {

using namespace eigengrain;
using nlohmann::json;

constexpr double stiffness = 1e5;  // N/m

json rows(const std::vector<Vec3>& column) {
  json all = json::array();
  for (const Vec3& row : column) all.push_back({row[0], row[1], row[2]});
  return all;
}

/// What a frame must say. The bodies are taken from the scene, which has them in the order of identity; the
/// force is put back there from the state's own order.
json expected(const test::SceneBuilder& builder, const assembly::State& state) {
  test::SceneBuilder copy = builder;
  const model::Bodies& given = copy.scene().bodies;
  std::vector<Vec3> force(state.force.size());
  for (std::size_t row = 0; row < force.size(); ++row)
    force[static_cast<std::size_t>(state.model.bodies.identity[row])] = state.force[row];
  json frame{{"time", state.time},     {"step", state.step},         {"position", rows(given.position)},
             {"radius", given.radius}, {"identity", given.identity}, {"velocity", rows(given.velocity)},
             {"force", rows(force)}};
  if (!given.spin.empty()) frame["spin"] = rows(given.spin);
  return frame;
}

/// A cluster of another shape for each step, frictionless so that its forces have a closed form: what differs
/// between frames must not get mixed up.
test::SceneBuilder cluster(std::int64_t step, bool turning) {
  std::mt19937_64 random(static_cast<std::uint64_t>(step) + 1);
  test::SceneBuilder builder = test::moving_cluster(random, turning);
  builder.plane({0, 0, -1.5}, {0, 0, 1});
  return builder;
}

/// No round number of steps makes a round time.
double time_of(std::int64_t step) {
  return static_cast<double>(step) / 3e4;
}

class Written {
 public:
  explicit Written(const std::filesystem::path& folder) : folder_(folder) {}

  void add(io::Series& series, const std::string& stem, std::int64_t step, bool turning) {
    const test::SceneBuilder builder = cluster(step, turning);
    const assembly::State state = test::state_of(builder, step, time_of(step));
    series.add(state);
    frames_[stem][std::to_string(step)] = expected(builder, state);
  }

  ~Written() {
    std::ofstream(folder_ / "expected.json") << json{{"stiffness", stiffness}, {"series", frames_}};
  }

 private:
  std::filesystem::path folder_;
  json frames_;
};

void write_all(const std::filesystem::path& folder) {
  Written written(folder);
  io::Series sliding(folder, "sliding");
  for (const std::int64_t step : {0, 1, 2}) written.add(sliding, "sliding", step, false);
  {
    io::Series killed(folder, "turning & more", io::Series::Of::balls, true);
    for (const std::int64_t step : {0, 10, 20, 30}) written.add(killed, "turning & more", step, true);
  }
  // Goes on from a checkpoint at 20, before frame 30, and writes others from there on.
  io::Series again(folder, "turning & more", io::Series::Of::balls, true);
  again.continue_from(20);
  for (const std::int64_t step : {20L, 30L, 12'345'678'901L})
    written.add(again, "turning & more", step, true);
}

/// Two bonds that broke, and a frame from before.
void write_breaks(const std::filesystem::path& folder) {
  const std::vector<assembly::BondBreak> breaks{
      {.step = 3, .time = 0.25, .first = 7, .second = 1, .place = {1, 2, 3}, .normal = {0, 0, 1}},
      {.step = 5,
       .time = 1.0 / 3,
       .first = 12'345'678'901,
       .second = 2,
       .place = {-0.1, 0, 1e-30},
       .normal = {0.6, -0.8, 0},
       .mode = contact::BreakMode::shear}};
  io::Series cracks(folder, "cracks", io::Series::Of::breaks);
  cracks.add(test::state_of(cluster(0, false), 0, 0));
  cracks.add(test::state_of(cluster(5, false), 5, 0.5), breaks);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  try {
    write_all(argv[1]);
    write_breaks(argv[1]);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
