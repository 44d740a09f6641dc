#include "eigengrain/assembly/solid.hpp"

#include "read_selection.hpp"
#include "scene_draft.hpp"
#include "volume_mesh_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <utility>

namespace eigengrain::io {
namespace {

using model::Deformable;
using Shape = decltype(model::Region::shape);

std::optional<model::Mesh> read_mesh_file(const Section& mesh, const std::filesystem::path& folder) {
  static const std::map<std::string, double> units{{"m", 1}, {"cm", 1e-2}, {"mm", 1e-3}, {"um", 1e-6}};
  mesh.check_keys();
  const auto name = mesh.text("file");
  const auto unit = mesh.text("unit");
  if (!name || !unit) return std::nullopt;
  const std::int64_t mistakes = mesh.diagnostics().count();
  model::Mesh result = read_volume_mesh((folder / *name).lexically_normal(), units.at(*unit),
                                        mesh.place("file"), mesh.diagnostics());
  if (result.elements.empty() || mesh.diagnostics().count() > mistakes) return std::nullopt;
  return result;
}

std::optional<model::Mesh> read_block(const Section& block) {
  static const std::map<std::string, model::ElementKind> kinds{{"hex8", model::ElementKind::hex8},
                                                               {"tet4", model::ElementKind::tet4},
                                                               {"tet10", model::ElementKind::tet10}};
  block.check_keys();
  const auto low = block.vector("min");
  const auto high = block.vector("max");
  const auto cells = block.integers("cells");
  const auto element = block.text("element");
  if (!low || !high || !cells || !element) return std::nullopt;
  if (cells->size() != 3) {
    block.report("cells", fmt::format("{} numbers; one for each of x, y and z is wanted, e.g. [4, 4, 2]",
                                      cells->size()));
    return std::nullopt;
  }
  constexpr double most_cells = 1e8;
  double count = 1;
  for (std::size_t k = 0; k < 3; ++k) count *= static_cast<double>((*cells)[k]);
  if (count > most_cells) {
    block.report("cells", fmt::format("{:.3g} bricks; up to {:.0e} are possible", count, most_cells));
    return std::nullopt;
  }
  for (int k = 0; k < 3; ++k) {
    if ((*low)[k] < (*high)[k]) continue;
    block.report("max", fmt::format("{0} = {1} m is not above the {0} = {2} m of min", "xyz"[k], (*high)[k],
                                    (*low)[k]));
    return std::nullopt;
  }
  return model::box_mesh(*low, *high - *low,
                         {static_cast<std::int32_t>((*cells)[0]), static_cast<std::int32_t>((*cells)[1]),
                          static_cast<std::int32_t>((*cells)[2])},
                         kinds.at(*element));
}

/// The key, or what the material has.
std::optional<double> modulus(const Section& entry, std::string_view key, std::optional<double> of_material,
                              const std::string& material) {
  if (entry.has(key)) return entry.quantity(key);
  if (!of_material) entry.report_missing(key, fmt::format(", and the material \"{}\" has none", material));
  return of_material;
}

/// Rows of nodes as they go into the scene's bodies.
struct Nodes {
  std::vector<model::FixedComponents> fixed;
  std::vector<Vec3> velocity;
  std::vector<Vec3> force;
};

bool in_shape(const Shape& shape, const Vec3& x) {
  return std::visit([&](const auto& s) { return model::contains(s, x); }, shape);
}

std::optional<Shape> read_part(const Section& part, const model::Mesh& mesh) {
  const auto shape = read_shape(part);
  if (!shape) return std::nullopt;
  if (std::ranges::any_of(mesh.nodes, [&](const Vec3& x) { return in_shape(*shape, x); })) return shape;
  Vec3 low = mesh.nodes.front();
  Vec3 high = low;
  for (const Vec3& x : mesh.nodes) {
    low = low.cwiseMin(x);
    high = high.cwiseMax(x);
  }
  part.report(
      fmt::format("no node lies in this region; the body reaches from ({:.4g}, {:.4g}, {:.4g}) to ({:.4g}, "
                  "{:.4g}, {:.4g}) m, and boxes leave out their upper sides",
                  low.x(), low.y(), low.z(), high.x(), high.y(), high.z()));
  return std::nullopt;
}

void read_fixities(const Section& entry, const model::Mesh& mesh, Nodes& nodes) {
  for (const Section& part : entry.sections("fix")) {
    part.check_keys();
    const auto axes = part.texts("axes");
    const bool moves = part.has("velocity");
    const auto velocity = moves ? part.vector("velocity") : std::optional<Vec3>(Vec3::Zero());
    const auto shape = read_part(part, mesh);
    if (!axes || !velocity || !shape) continue;
    for (std::size_t i = 0; i < mesh.nodes.size(); ++i) {
      if (!in_shape(*shape, mesh.nodes[i])) continue;
      for (const std::string& axis : *axes) {
        const int k = axis[0] - 'x';
        nodes.fixed[i].fix(k);
        if (moves) nodes.velocity[i][k] = (*velocity)[k];
      }
    }
  }
}

void read_loads(const Section& entry, const model::Mesh& mesh, Nodes& nodes) {
  const std::vector<Section> loads = entry.sections("loads");
  if (loads.empty()) return;
  std::vector<std::int32_t> node;
  const model::Surface skin = model::skin_of(mesh, node);
  for (const Section& load : loads) {
    load.check_keys();
    const auto force = load.vector("force");
    const auto shape = read_part(load, mesh);
    if (!force || !shape) continue;
    std::vector<double> share(mesh.nodes.size(), 0.0);
    double whole = 0;
    for (const model::Triangle& triangle : skin.triangles) {
      const auto at = [&](std::size_t k) -> const Vec3& {
        return skin.vertices[static_cast<std::size_t>(triangle[k])];
      };
      if (!in_shape(*shape, at(0)) || !in_shape(*shape, at(1)) || !in_shape(*shape, at(2))) continue;
      const double area = 0.5 * (at(1) - at(0)).cross(at(2) - at(0)).norm();
      whole += area;
      for (const std::int32_t corner : triangle)
        share[static_cast<std::size_t>(node[static_cast<std::size_t>(corner)])] += area / 3;
    }
    if (whole == 0) {
      load.report("no triangle of the skin lies in this region with all of its corners; make it larger");
      continue;
    }
    if (nodes.force.empty()) nodes.force.assign(mesh.nodes.size(), Vec3::Zero());
    for (std::size_t i = 0; i < share.size(); ++i) nodes.force[i] += share[i] / whole * *force;
  }
}

model::Bodies bodies_of(const Deformable& deformable, Nodes nodes, double damping) {
  model::Bodies rows = assembly::nodes_of(deformable);
  for (std::size_t i = 0; i < nodes.fixed.size(); ++i) rows.fixed[i] = rows.fixed[i].with(nodes.fixed[i]);
  if (std::ranges::any_of(nodes.velocity, [](const Vec3& v) { return !v.isZero(0); }))
    rows.velocity = std::move(nodes.velocity);
  rows.applied_force = std::move(nodes.force);
  if (damping != model::Bodies::scene_damping) rows.damping.assign(rows.mass.size(), damping);
  return rows;
}

}  // namespace

void append_nodes(SceneDraft& draft) {
  for (std::size_t d = 0; d < draft.nodes.size(); ++d) {
    draft.scene.deformables[d].first_node = std::ssize(draft.scene.bodies.position);
    model::append_rows(draft.scene.bodies, draft.nodes[d]);
  }
}

void read_deformables(const Section& root, SceneDraft& draft) {
  const std::vector<Section> entries = root.sections("deformables");
  if (!entries.empty() && draft.scene.cell.any())
    root.report("deformables",
                "in a cell that repeats, deformable bodies are not possible; leave out `periodic` or them");
  if (!entries.empty() && draft.planar)
    root.report("deformables",
                "in a planar scene, deformable bodies are not possible; leave out `planar` or them");
  std::size_t number = 0;
  for (const Section& entry : entries) {
    entry.check_keys();
    Deformable deformable;
    deformable.name = entry.text("name").value_or(fmt::format("deformable {}", ++number));
    deformable.material = read_material(entry, "material", draft.scene);
    if (entry.has("mesh") == entry.has("block")) {
      entry.report("either a mesh or a block is wanted, e.g. \"mesh: {file: block.msh, unit: mm}\"");
      continue;
    }
    const auto mesh_section = entry.section("mesh");
    const auto block_section = entry.section("block");
    auto mesh = mesh_section    ? read_mesh_file(*mesh_section, draft.folder)
                : block_section ? read_block(*block_section)
                                : std::nullopt;
    const auto move = entry.vector("move");
    const auto velocity = entry.vector("velocity");
    const auto model = entry.text("model");
    if (std::ranges::any_of(draft.scene.deformables,
                            [&](const Deformable& d) { return d.name == deformable.name; }))
      entry.report("name",
                   fmt::format("\"{}\" is the name of another body; choose another one", deformable.name));
    if (deformable.material < 0 || !mesh || !move || !velocity || !model) continue;
    const model::Material& material = draft.scene.materials[static_cast<std::size_t>(deformable.material)];
    if (material.density == 0)
      entry.report("material", fmt::format("\"{}\" has no density; add e.g. \"density: 1100 kg/m3\" to it",
                                           material.name));
    const auto young = modulus(entry, "young", material.young, material.name);
    const auto poisson = modulus(entry, "poisson", material.poisson, material.name);
    const auto damping = entry.has("damping") ? entry.quantity("damping")
                                              : std::optional<double>(model::Bodies::scene_damping);
    if (!young || !poisson || !damping || material.density == 0) continue;
    for (const model::ElasticModel known :
         {model::ElasticModel::linear, model::ElasticModel::corotational,
          model::ElasticModel::saint_venant_kirchhoff, model::ElasticModel::neo_hookean})
      if (name_of(known) == *model) deformable.solid.model = known;
    deformable.solid.young = *young;
    deformable.solid.poisson = *poisson;
    deformable.density = material.density;
    deformable.mesh = std::move(*mesh);
    deformable.mesh.name = deformable.name;
    for (Vec3& x : deformable.mesh.nodes) x += *move;
    Nodes nodes;
    nodes.fixed.resize(deformable.mesh.nodes.size());
    nodes.velocity.assign(deformable.mesh.nodes.size(), *velocity);
    read_fixities(entry, deformable.mesh, nodes);
    read_loads(entry, deformable.mesh, nodes);
    draft.nodes.push_back(bodies_of(deformable, std::move(nodes), *damping));
    draft.scene.deformables.push_back(std::move(deformable));
  }
}

}  // namespace eigengrain::io
