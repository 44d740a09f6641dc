#pragma once

#include "eigengrain/base/vec.hpp"
#include "eigengrain/model/deformable.hpp"

/// What a point of an elastic solid does: stress, energy and stiffness of a deformation gradient. With F the
/// derivative of the present place by that without stress, and energies by volume without stress:
///
///   linear                  W = µ ε:ε + λ/2 tr²ε,        ε = sym(F - 1); only for small rotations
///   corotational            the same with ε = RᵀF - 1,   F = R S by polar decomposition
///   saint-venant-kirchhoff  the same with ε = (FᵀF - 1)/2
///   neo-hookean             W = µ/2 (tr FᵀF - 3) - µ ln J + λ/2 ln²J,  J = det F
///
/// (Bonet and Wood, Nonlinear Continuum Mechanics, 2nd ed. 2008, sections 6.4 and 6.5; for corotational
/// tangents McAdams et al., ACM Trans. Graph. 30:37, 2011.)
namespace eigengrain::fem {

using Mat9 = Eigen::Matrix<double, 9, 9>;

/// The rotation of F = R S, S symmetric, for det F > 0 (Higham, SIAM J. Sci. Stat. Comput. 7:1160, 1986);
/// else not a number.
Mat3 polar_rotation(const Mat3& F);

/// First Piola-Kirchhoff stress ∂W/∂F, Pa. Not a number where a corotational or neo-Hookean solid is inside
/// out.
Mat3 stress(const model::ElasticSolid& solid, const Mat3& F);
/// W, J/m³.
double energy_density(const model::ElasticSolid& solid, const Mat3& F);
/// ∂²W/∂F∂F, symmetric, on F as nine numbers column after column, Pa.
Mat9 elasticity(const model::ElasticSolid& solid, const Mat3& F);
/// True stress σ = P Fᵀ/J, Pa; of a linear solid P itself.
Mat3 cauchy_stress(const model::ElasticSolid& solid, const Mat3& F);

}  // namespace eigengrain::fem
