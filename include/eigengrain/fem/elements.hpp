#pragma once

#include "eigengrain/base/vec.hpp"
#include "eigengrain/model/deformable.hpp"

#include <cstdint>
#include <span>
#include <vector>

/// Finite elements: shape functions at integration points, and what follows from them.
namespace eigengrain::fem {

/// Most nodes of an element.
inline constexpr int most_nodes = 10;

/// What the elements of a mesh are without stress: the derivatives of their shape functions by place, and the
/// volume that each integration point stands for. tet4 has one point, tet10 four (Keast, Comput. Meth. Appl.
/// Mech. Eng. 55:339, 1986, degree 2), hex8 the eight of Gauss.
class Elements {
 public:
  explicit Elements(const model::Mesh& mesh);

  int nodes() const { return nodes_; }
  int points() const { return points_; }
  std::int32_t size() const { return size_; }
  /// Volume of point q of element e, m³.
  double weight(std::int32_t e, int q) const { return weight_[at(e, q)]; }
  /// ∇N of its nodes there [nodes × 3], 1/m.
  std::span<const double> gradients(std::int32_t e, int q) const {
    const auto numbers = static_cast<std::size_t>(3 * nodes_);
    return std::span(gradient_).subspan(numbers * at(e, q), numbers);
  }
  /// F = Σ x_i ∇N_iᵀ with the nodes of element e at x [nodes].
  Mat3 deformation(std::int32_t e, int q, std::span<const Vec3> x) const;

  /// Forces of element e on its nodes at x: -Σ_q V_q P ∇N_i, N.
  void forces(const model::ElasticSolid& solid, std::int32_t e, std::span<const Vec3> x,
              std::span<Vec3> forces) const;
  /// Its stored energy, J.
  double energy(const model::ElasticSolid& solid, std::int32_t e, std::span<const Vec3> x) const;
  /// K_ij = Σ_q V_q ∇N_i · ∂P/∂F · ∇N_j: minus the derivative of forces(), symmetric [3 nodes × 3 nodes],
  /// N/m.
  Eigen::MatrixXd stiffness(const model::ElasticSolid& solid, std::int32_t e, std::span<const Vec3> x) const;
  /// The mean over its volume of Cauchy's stress, Pa.
  Mat3 mean_stress(const model::ElasticSolid& solid, std::int32_t e, std::span<const Vec3> x) const;

 private:
  std::size_t at(std::int32_t e, int q) const {
    return static_cast<std::size_t>(points_) * static_cast<std::size_t>(e) + static_cast<std::size_t>(q);
  }

  int nodes_;
  int points_;
  std::int32_t size_;
  std::vector<double> weight_;    ///< [elements × points]
  std::vector<double> gradient_;  ///< [elements × points × nodes × 3]
};

/// The consistent mass matrix of an element, [nodes × nodes] of multiples of 1, kg: for comparison; the cycle
/// lumps.
Eigen::MatrixXd consistent_mass(const model::Mesh& mesh, std::int32_t element, double density);

/// Mass of each node, kg: the diagonal of the consistent mass, scaled so that elements keep their mass
/// (Hinton, Rock and Zienkiewicz, Earthq. Eng. Struct. Dyn. 4:245, 1976). Positive for all kinds.
std::vector<double> lumped_masses(const model::Mesh& mesh, double density);

}  // namespace eigengrain::fem
