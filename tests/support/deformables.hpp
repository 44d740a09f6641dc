#pragma once

#include "eigengrain/assembly/solid.hpp"
#include "eigengrain/model/mesh.hpp"

#include "support/scenes.hpp"

#include <utility>

/// Deformable bodies in scenes for tests.
namespace eigengrain::test {

/// Adds a body, behind all balls. fixed(x): components of the node at x that stay.
template <class Fixed>
void add_deformable(SceneBuilder& builder, model::Mesh mesh, const model::ElasticSolid& solid, double density,
                    const Fixed& fixed) {
  model::Scene& scene = builder.scene();
  model::Deformable deformable{.name = "block", .mesh = std::move(mesh), .solid = solid, .density = density};
  deformable.first_node = scene.bodies.size();
  model::Bodies nodes = assembly::nodes_of(deformable);
  for (std::size_t i = 0; i < nodes.position.size(); ++i)
    nodes.fixed[i] = nodes.fixed[i].with(fixed(nodes.position[i]));
  model::append_rows(scene.bodies, nodes);
  scene.deformables.push_back(std::move(deformable));
}

inline model::FixedComponents free_nodes(const Vec3& /*x*/) {
  return {};
}

/// Fixes what lies below a height.
inline auto fixed_below(double height) {
  return [=](const Vec3& x) { return x.z() < height ? model::FixedComponents(7) : model::FixedComponents(); };
}

inline constexpr model::ElementKind all_element_kinds[] = {model::ElementKind::tet4, model::ElementKind::hex8,
                                                           model::ElementKind::tet10};

}  // namespace eigengrain::test
