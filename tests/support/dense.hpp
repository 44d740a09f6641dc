#pragma once

#include "eigengrain/assembly/eigen_matrix.hpp"
#include "eigengrain/assembly/linear_system.hpp"

#include <cmath>
#include <cstddef>
#include <span>

/// Critical timesteps by dense algebra, s.
namespace eigengrain::test {

/// 2/√λ_max, undamped.
double dense_truth(const assembly::LinearSystem& system);

/// 2/μ, μ the largest root of det(μ² M' - μ C - K) = 0, M' = M/(1 + α), by the companion matrix of the whole
/// quadratic problem.
///
/// local_damping  [bodies] α of each, or empty where none is damped
double dense_limit(const assembly::LinearSystem& system, std::span<const double> local_damping);

}  // namespace eigengrain::test
