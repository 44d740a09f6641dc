#pragma once

#include "eigengrain/base/adjacency.hpp"
#include "eigengrain/base/vec.hpp"
#include "eigengrain/fem/elements.hpp"
#include "eigengrain/model/bodies.hpp"
#include "eigengrain/model/deformable.hpp"
#include "eigengrain/model/surface.hpp"

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace eigengrain::assembly {

struct Model;

/// A deformable body in a model: what of it never changes. Its nodes are bodies without radius.
struct Solid {
  /// The rows of the nodes are looked up in the bodies, whose order stays from now on.
  Solid(model::Deformable what, const model::Bodies& bodies);

  model::Deformable deformable;      ///< its elements in the order of the rows of their nodes
  std::vector<std::int32_t> number;  ///< [elements] which element of the mesh each one was, for people
  fem::Elements elements;
  std::vector<std::int32_t> row;                        ///< [nodes] row in Bodies
  std::vector<std::int32_t> rows;                       ///< [elements × nodes of one] the same
  Adjacency corners;                                    ///< [nodes] places in `rows`
  model::Surface skin;                                  ///< where the mesh is without stress
  std::vector<std::int32_t> skin_row;                   ///< [vertices of the skin]
  std::vector<std::array<std::int32_t, 3>> neighbours;  ///< [triangles of the skin] across each edge
  std::int32_t first_facet = 0;                         ///< in Model::facets
  std::int32_t first_vertex = 0;

  /// Where the nodes of element e are, from the positions of all bodies. x [nodes of one]
  void gather(std::int32_t e, std::span<const Vec3> position, std::span<Vec3> x) const {
    const auto n = static_cast<std::size_t>(elements.nodes());
    for (std::size_t i = 0; i < n; ++i)
      x[i] = position[static_cast<std::size_t>(rows[n * static_cast<std::size_t>(e) + i])];
  }
};

/// The nodes of a deformable body as bodies: at rest, with lumped masses, and never turning.
model::Bodies nodes_of(const model::Deformable& deformable);

/// Solids in a model are shared: copies of a state have the same.
using Solids = std::vector<std::shared_ptr<const Solid>>;

/// Whether a row is a node of a deformable body: a body without size.
inline bool is_node(const model::Bodies& bodies, std::size_t row) {
  return bodies.radius[row] == 0;
}

/// Makes the solids of a scene and adds their skins to the surfaces of a model, whose bodies are in their
/// final order.
void set_solids(Model& model, std::span<const model::Deformable> deformables);

/// Puts the facets of all skins where their nodes are, at these positions [bodies].
void place_skins(const Solids& solids, std::span<const Vec3> position, model::Facets& facets);

/// Has the trees of the skins made anew, for a search where their facets are now.
void renew_skins(Model& model);

/// The forces of elements on their nodes. Threads share the elements, then the nodes; every sum is in the
/// order of the elements, so that the result is the same to the bit on any number of threads. Cost
/// O(elements), nothing allocated in a steady state.
class SolidForces {
 public:
  /// Adds them to `force` [bodies], with the nodes at `position` [bodies].
  void add(const Solids& solids, std::span<const Vec3> position, std::span<Vec3> force);

 private:
  std::vector<Vec3> of_corner_;  ///< [elements × nodes of one] of one solid
};

/// Throws SolverError where the forces on a node are none, as an element was turned inside out. [bodies]
void check_solids(const Solids& solids, std::span<const Vec3> position, std::span<const Vec3> force);

/// Stored energy of all elements, J.
double elastic_energy_of(const Solids& solids, std::span<const Vec3> position);

/// Calls add(row_i, row_j, K_ij, n) for the 3×3 blocks of K of all elements (N/m), element after element; n:
/// nodes of the element.
template <class Add>
void for_each_node_block(const Solids& solids, std::span<const Vec3> position, const Add& add) {
  for (const auto& solid : solids) {
    const int n = solid->elements.nodes();
    std::array<Vec3, fem::most_nodes> x;
    for (std::int32_t e = 0; e < solid->elements.size(); ++e) {
      solid->gather(e, position, x);
      const Eigen::MatrixXd k = solid->elements.stiffness(solid->deformable.solid, e,
                                                          std::span(x).first(static_cast<std::size_t>(n)));
      const std::span<const std::int32_t> rows =
          std::span(solid->rows).subspan(static_cast<std::size_t>(n) * static_cast<std::size_t>(e));
      for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j)
          add(rows[static_cast<std::size_t>(i)], rows[static_cast<std::size_t>(j)],
              Mat3(k.block<3, 3>(3 * i, 3 * j)), n);
    }
  }
}

}  // namespace eigengrain::assembly
