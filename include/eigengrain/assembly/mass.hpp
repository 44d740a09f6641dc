#pragma once

#include "eigengrain/assembly/unknowns.hpp"
#include "eigengrain/model/bodies.hpp"

#include <vector>

namespace eigengrain::assembly {

/// The diagonal of M [unknowns.size()]: mass for a u (kg), moment of inertia for a θ (kg m²).
/// Masked components carry it too; it is never zero.
std::vector<double> mass_diagonal(const model::Bodies& bodies, const Unknowns& unknowns);

/// The diagonal of M^-½ [unknowns.size()], with zeros at masked components: scaling K by it from both sides
/// gives the symmetric matrix whose eigenvalues are those of M⁻¹K on the free components (and zeros).
std::vector<double> inverse_sqrt_mass(const model::Bodies& bodies, const Unknowns& unknowns);

}  // namespace eigengrain::assembly
