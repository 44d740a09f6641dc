#pragma once

#include "eigengrain/assembly/linear_system.hpp"

#include <optional>
#include <span>

/// The proof that no eigenvalue is larger than the one that was found.
namespace eigengrain::timestep {

/// Whether all eigenvalues of S K S are less than sigma, by a sparse supernodal Cholesky factorisation
/// (CHOLMOD) of sigma - S K S: it runs to its end exactly if the matrix is positive definite, up to rounding.
///
/// Returns what is proven of all eigenvalues, a little more than sigma. A factor RᵀR of A that was computed
/// to its end has |RᵀR - A|_2 <= γ/(1 - γ) tr A, γ = (s + 2)u/(1 - (s + 2)u), s the numbers in a row of the
/// factor, in whatever order sums are made (Rump, Verification of positive definiteness, BIT 46:433, 2006).
/// That, and what the sums in the entries of S K S may have lost, is added: 4e-8 of sigma for 60,000 unknowns
/// of a packing, 2e-6 for 600,000. Nothing where the factorisation breaks down: an eigenvalue is larger than
/// sigma, or nearer to it than that.
///
/// scale  [unknowns.size()] the diagonal of S
/// Throws SolverError where the factor does not fit into the memory that is free; it is asked before it is
/// taken.
std::optional<double> prove_below(const assembly::Unknowns& unknowns, const assembly::StiffnessParts& parts,
                                  std::span<const double> scale, double sigma);

}  // namespace eigengrain::timestep
