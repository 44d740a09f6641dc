#pragma once

#include "eigengrain/assembly/model.hpp"
#include "eigengrain/assembly/nodal_stiffness.hpp"
#include "eigengrain/assembly/stiffness.hpp"
#include "eigengrain/assembly/unknowns.hpp"
#include "eigengrain/contact/element.hpp"

#include <vector>

namespace eigengrain::assembly {

/// Whether any contact of a model, listed or to come, has dashpots by its law.
bool has_dashpots(const Model& model);

/// K, M and dashpots of a model as it stands, factored into its contacts: what estimates, bounds and solvers
/// are asked about. It owns what it holds; the model may go.
struct LinearSystem {
  explicit LinearSystem(const Model& model, Listed which = Listed::acting);

  std::vector<contact::ContactElement> elements;
  /// [elements] the dashpots of the elements; empty where no contact has any.
  std::vector<contact::ContactDamping> damping;
  Unknowns unknowns;
  NodalStiffness nodal;  ///< of deformable bodies; empty where there are none
  /// [unknowns.size()] the diagonal of M: mass for a u (kg), moment of inertia for a θ (kg m²), of
  /// clumps the three principal ones; the inertial ones where masses are scaled. Masked
  /// components carry it too; it is never zero.
  std::vector<double> mass;

  /// All of K.
  StiffnessParts parts() const { return {elements, nodal}; }
  bool has_dashpots() const { return !damping.empty() || !nodal.viscous.empty(); }

  /// [unknowns.size()] the diagonal of M^-½, with zeros at masked components: scaling K by it from both sides
  /// gives the symmetric matrix whose eigenvalues are those of M⁻¹K on the free components (and zeros).
  std::vector<double> inverse_sqrt_mass() const;
  /// [bodies] The same as (u, θ) of each body, zero where a component is fixed or does not exist.
  std::vector<Vec6> inverse_sqrt_mass_of_bodies() const;
};

/// The same system with K + μC in place of K, C the matrix of its dashpots: what decides how long the steps
/// of the damped cycle may be (docs/theory.md). μ in 1/s.
LinearSystem with_viscosity(const LinearSystem& system, double mu);

/// The same with C in place of K.
LinearSystem viscous_part(const LinearSystem& system);

/// C alone: contacts whose stiffness is that of their dashpots, N s/m for N/m.
std::vector<contact::ContactElement> viscous_elements(const LinearSystem& system);

}  // namespace eigengrain::assembly
