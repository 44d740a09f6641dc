#include "eigengrain/io/suggest.hpp"

#include "scene_draft.hpp"

#include <fmt/format.h>

namespace eigengrain::io {
namespace {

/// Index of the material of that name, or -1.
std::int32_t find_material(const model::Scene& scene, std::string_view name) {
  for (std::size_t k = 0; k < scene.materials.size(); ++k)
    if (scene.materials[k].name == name) return static_cast<std::int32_t>(k);
  return -1;
}

void check_name(const Section& section, const std::string& name, const SceneDraft& draft) {
  const std::int32_t same = find_material(draft.scene, name);
  if (name == "any")
    section.report("name", "\"any\" stands for every material; choose another name");
  else if (same >= 0)
    section.report(
        "name", fmt::format("\"{}\" is the name of a material on line {} already; choose another name", name,
                            draft.material_places[same].line));
}

}  // namespace

void read_materials(const Section& root, SceneDraft& draft) {
  for (const Section& section : root.sections("materials")) {
    section.check_keys();
    const auto name = section.text("name");
    // A density that is wrong has been reported; 1 stands in for it, so that it is not missed again.
    const double density = section.quantity("density").value_or(section.has("density") ? 1.0 : 0.0);
    if (!name) continue;
    check_name(section, *name, draft);
    draft.scene.materials.push_back({.name = *name,
                                     .density = density,
                                     .rigid = section.flag("rigid").value_or(false),
                                     .young = section.quantity("young"),
                                     .poisson = section.quantity("poisson"),
                                     .kn = section.quantity("kn"),
                                     .ks = section.quantity("ks")});
    draft.material_places.push_back(section.place());
  }
}

std::int32_t read_material(const Section& section, std::string_view key, const model::Scene& scene) {
  const auto name = section.text(key);
  if (!name) return -1;
  const std::int32_t material = find_material(scene, *name);
  if (material >= 0) return material;
  std::vector<std::string> names;
  for (const model::Material& each : scene.materials) names.push_back(each.name);
  std::string guess = did_you_mean(*name, names);
  if (guess.empty()) guess = fmt::format("; add \"- {{name: {}, density: 2500 kg/m3}}\" to materials", *name);
  section.report(key, fmt::format("unknown material \"{}\"{}", *name, guess));
  return -1;
}

}  // namespace eigengrain::io
