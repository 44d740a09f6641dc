#include "read_selection.hpp"

#include "eigengrain/io/suggest.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>
#include <vector>

namespace eigengrain::io {
namespace {

std::optional<model::SphereRegion> read_sphere(const Section& section) {
  section.check_keys();
  const auto centre = section.vector("centre");
  const auto radius = section.quantity("radius");
  if (!centre || !radius) return std::nullopt;
  return model::SphereRegion{*centre, *radius};
}

std::optional<model::BoxRegion> read_box(const Section& section) {
  section.check_keys();
  const auto min = section.vector("min");
  const auto max = section.vector("max");
  if (!min || !max) return std::nullopt;
  bool open = true;
  for (int k = 0; k < 3; ++k)
    if (!((*min)[k] < (*max)[k])) {
      section.report("max", fmt::format("{} m along {}, and min is {} m; max must be larger", (*max)[k],
                                        static_cast<char>('x' + k), (*min)[k]));
      open = false;
    }
  return open ? std::optional(model::BoxRegion{*min, *max}) : std::nullopt;
}

std::vector<std::string> names_of_walls(const model::Scene& scene) {
  std::vector<std::string> names;
  for (const model::Plane& wall : scene.walls) names.push_back(wall.name);
  for (const model::Surface& surface : scene.surfaces) names.push_back(surface.name);
  return names;
}

}  // namespace

std::optional<decltype(model::Region::shape)> read_shape(const Section& section) {
  const auto sphere = section.section("sphere");
  const auto box = section.section("box");
  if (sphere && box) {
    section.report("box", "a region is a sphere or a box, not both; make it two entries");
    return std::nullopt;
  }
  if (sphere) return read_sphere(*sphere);
  if (box) return read_box(*box);
  if (section.has("sphere") || section.has("box")) return std::nullopt;
  return model::WholeRegion{};
}

model::Selection read_selection(const Section& section, const SceneDraft& draft) {
  model::Selection selection;
  if (section.has("sphere") || section.has("box"))
    if (auto shape = read_shape(section)) selection.region = model::Region{section.path(), std::move(*shape)};
  if (section.has("material")) selection.material = read_material(section, "material", draft.scene);
  if (section.has("balls")) selection.balls = section.integers("balls");
  return selection;
}

void check_wall_name(const Section& section, const std::string& wall, const SceneDraft& draft) {
  const std::vector<std::string> names = names_of_walls(draft.scene);
  if (!draft.walls_complete || std::find(names.begin(), names.end(), wall) != names.end()) return;
  section.report("wall", names.empty() ? fmt::format("there is no wall \"{}\", as the scene has none", wall)
                                       : fmt::format("there is no wall \"{}\"{} (walls: {})", wall,
                                                     did_you_mean(wall, names), fmt::join(names, ", ")));
}

}  // namespace eigengrain::io
