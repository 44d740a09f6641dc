#pragma once

#include "eigengrain/assembly/linear_system.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace eigengrain::cycle {

/// Which bodies are made heavier, and by how much, so that a step is proven (selective mass scaling).
struct Lift {
  std::vector<double> factor;  ///< [bodies] c >= 1, inertial over present mass and moments
  std::vector<double> weight;  ///< [bodies] d, the weights of the proof
  double added = 0;            ///< Σ (c_i - 1) m_i, kg
  std::int32_t heavier = 0;    ///< bodies with c > 1
  double largest = 1;          ///< c of the heaviest change
};

struct LiftOptions {
  int sweeps = 40;  ///< each looks once at the block of every body
};

/// The masses that make 2/μ a proven step of the cycle, by as little mass as weights of the bodies can do it
/// with (docs/theory.md, "Selective mass scaling"). For any weights d > 0
///
///   c_i = max(1, λ_max(M_i'^-½ [Σ_c (1 + d_j/d_i) (K + μC)_c,ii] M_i'^-½) / μ²),   M_i' = M_i/(1 + α_i)
///
/// proves it. The added mass is a convex function of log d, whose minimum balances what raising d_i takes
/// from body i and gives to its neighbours. It is approached by sweeps of Osborne's balancing (J. ACM 7:338,
/// 1960), the contact forms taken along the eigenvectors of the blocks, with the kink at c = 1 rounded off
/// less and less; the best of all sweeps counts. Nothing is lifted where the step is proven as it is.
///
/// Cost: one 6×6 eigenpair for each body near its limit, and sweep. The same to the bit on any number of
/// threads.
///
/// mass           [bodies] what a lift by a factor of two costs, kg
/// local_damping  [bodies] α of each, or empty where none is damped
/// wished         s, finite and positive
Lift lift(const assembly::LinearSystem& system, std::span<const double> mass,
          std::span<const double> local_damping, double wished, const LiftOptions& options = {});

/// What given weights need, d [bodies] > 0: with d = 1 each body by its own block.
Lift lift_of_weights(const assembly::LinearSystem& system, std::span<const double> mass,
                     std::span<const double> local_damping, double wished, std::vector<double> weights);

/// The system with masses and moments times a factor a body. Dashpots stay.
assembly::LinearSystem lifted(assembly::LinearSystem system, std::span<const double> factor);

}  // namespace eigengrain::cycle
