#include "eigengrain/spectrum/modes.hpp"

#include "eigengrain/assembly/eigen_matrix.hpp"
#include "eigengrain/assembly/product.hpp"
#include "eigengrain/base/error.hpp"
#include "eigengrain/petsc/session.hpp"
#include "eigengrain/timestep/low_modes.hpp"

#include "timestep/krylov.hpp"
#include "timestep/memory.hpp"

#include <fmt/format.h>
#include <slepcblaslapack.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace eigengrain::spectrum {
namespace {

using assembly::LinearSystem;
using assembly::StiffnessProduct;
using assembly::Unknowns;

/// σ over λ_max for the slowest modes: none down to about its size is missed.
constexpr double shift = 1e-8;

/// Eigenvalues below this part of the largest one are zeros.
constexpr double zero_part = 1e-10;

/// The eigenvectors, if there are any, belong to the scaled problem on the free components.
Modes with_residuals(const LinearSystem& system, const Eigen::VectorXd& lambda,
                     const Eigen::MatrixXd* vectors) {
  Modes result;
  const std::vector<double> scale = system.inverse_sqrt_mass();
  const std::vector<std::int32_t> free = system.unknowns.free_components();
  StiffnessProduct product(system.unknowns, system.parts(), scale);
  const double largest = lambda.size() > 0 ? lambda[lambda.size() - 1] : 0.0;
  std::vector<double> y(scale.size());
  std::vector<double> image(scale.size());
  for (Eigen::Index k = 0; k < lambda.size(); ++k) {
    result.lambda.push_back(lambda[k]);
    if (vectors == nullptr) continue;
    for (std::size_t i = 0; i < free.size(); ++i)
      y[static_cast<std::size_t>(free[i])] = (*vectors)(static_cast<Eigen::Index>(i), k);
    product.apply(y, image);
    double squared = 0;
    for (std::size_t i = 0; i < y.size(); ++i) squared += std::pow(image[i] - lambda[k] * y[i], 2);
    const double size = std::abs(lambda[k]) > zero_part * largest ? std::abs(lambda[k]) : largest;
    result.residual.push_back(size > 0 ? std::sqrt(squared) / size : 0.0);
    std::vector<double>& shape = result.shape.emplace_back(y);
    for (std::size_t i = 0; i < shape.size(); ++i) shape[i] *= scale[i];
  }
  return result;
}

}  // namespace

Modes highest_modes(const LinearSystem& system, int count, const timestep::TruthOptions& options) {
  Modes result;
  if (count < 1)
    throw InputError(fmt::format("{} of the highest modes; a number from 1 up is wanted", count));
  if (system.unknowns.free_components().empty()) return result;
  petsc::start();
  const std::vector<double> scale = system.inverse_sqrt_mass();
  StiffnessProduct product(system.unknowns, system.parts(), scale);
  for (const timestep::Eigenpair& pair : timestep::largest_eigenpairs(product, scale, count, options)) {
    result.lambda.push_back(pair.value);
    result.residual.push_back(pair.residual);
    result.shape.push_back(timestep::mode_of(pair.vector.get(), scale));
  }
  return result;
}

Modes lowest_modes(const LinearSystem& system, int count) {
  if (count < 1) throw InputError(fmt::format("{} of the lowest modes; a number from 1 up is wanted", count));
  const Modes top = highest_modes(system, 1);
  if (top.lambda.empty() || !(top.lambda.front() > 0)) return {};
  timestep::LowModes found =
      timestep::low_modes(system, count, top.lambda.front(), {.shapes = true, .shift = shift});
  return {.lambda = std::move(found.lambda),
          .residual = std::move(found.residual),
          .shape = std::move(found.shape)};
}

Modes all_modes(const LinearSystem& system, bool shapes) {
  const auto free = static_cast<std::int64_t>(system.unknowns.free_components().size());
  if (free > dense_unknowns)
    throw InputError(
        fmt::format("all modes of {} unknowns would take a dense matrix of {:.0f} GB; ask for the lowest and "
                    "highest ones, or for "
                    "the density of states (up to {} unknowns all are computed)",
                    free, 8e-9 * static_cast<double>(free) * static_cast<double>(free), dense_unknowns));
  if (free == 0) return {};
  const double wanted = 8.0 * (shapes ? 3 : 1) * static_cast<double>(free) * static_cast<double>(free);
  if (const double available = timestep::available_memory(); wanted > available)
    throw SolverError(
        fmt::format("all modes of {} unknowns want {:.1f} GB, and {:.1f} GB of memory are free; ask for the "
                    "lowest and highest ones, or for the density of states",
                    free, wanted / 1e9, available / 1e9));
  petsc::start();  // holds BLAS to one thread
  Eigen::MatrixXd a = assembly::dense_scaled_stiffness(system);
  Eigen::VectorXd lambda(free);
  auto n = static_cast<PetscBLASInt>(free);
  PetscBLASInt info = 0;
  PetscBLASInt ask = -1;
  double work_size = 0;
  PetscBLASInt integer_size = 0;
  const char* job = shapes ? "V" : "N";
  LAPACKsyevd_(job, "L", &n, a.data(), &n, lambda.data(), &work_size, &ask, &integer_size, &ask, &info);
  std::vector<double> work(static_cast<std::size_t>(work_size));
  std::vector<PetscBLASInt> integers(static_cast<std::size_t>(integer_size));
  auto work_length = static_cast<PetscBLASInt>(work.size());
  LAPACKsyevd_(job, "L", &n, a.data(), &n, lambda.data(), work.data(), &work_length, integers.data(),
               &integer_size, &info);
  if (info != 0) throw SolverError(fmt::format("LAPACK's dsyevd failed with {} on all modes", info));
  return with_residuals(system, lambda, shapes ? &a : nullptr);
}

BodyMotion motion_of_bodies(const LinearSystem& system, std::span<const double> shape) {
  const Unknowns& unknowns = system.unknowns;
  const auto bodies = static_cast<std::size_t>(unknowns.bodies());
  BodyMotion motion{std::vector<Vec3>(bodies, Vec3::Zero()), std::vector<Vec3>(bodies, Vec3::Zero()),
                    std::vector<double>(bodies, 0.0)};
  for (std::int32_t block = 0; block < unknowns.blocks(); ++block) {
    const std::int32_t body = unknowns.body(block);
    const std::size_t first = std::size_t{Unknowns::block_size} * static_cast<std::size_t>(block);
    const Vec3 value = Eigen::Map<const Vec3>(&shape[first]);
    motion.energy[body] += value.cwiseAbs2().dot(Eigen::Map<const Vec3>(&system.mass[first]));
    if (!unknowns.is_rotation(block))
      motion.displacement[body] = value;
    else
      motion.rotation[body] = unknowns.axes(body) != nullptr ? Vec3(*unknowns.axes(body) * value) : value;
  }
  return motion;
}

Character character_of(const LinearSystem& system, std::span<const double> shape) {
  const Unknowns& unknowns = system.unknowns;
  std::vector<double> energy(static_cast<std::size_t>(unknowns.bodies()), 0.0);
  std::vector<bool> moves(energy.size(), false);
  double translation = 0;
  for (std::int32_t block = 0; block < unknowns.blocks(); ++block) {
    double part = 0;
    for (int k = 0; k < Unknowns::block_size; ++k) {
      const auto i = static_cast<std::size_t>(Unknowns::block_size * block + k);
      part += system.mass[i] * shape[i] * shape[i];
    }
    energy[unknowns.body(block)] += part;
    moves[unknowns.body(block)] = true;
    if (!unknowns.is_rotation(block)) translation += part;
  }
  double sum = 0;
  double squares = 0;
  for (const double e : energy) {
    sum += e;
    squares += e * e;
  }
  if (!(sum > 0)) return {};
  const auto bodies = static_cast<double>(std::ranges::count(moves, true));
  const auto most = std::ranges::max_element(energy);
  return {.participation = sum * sum / (bodies * squares),
          .translation = translation / sum,
          .largest = static_cast<std::int32_t>(most - energy.begin()),
          .largest_share = *most / sum};
}

}  // namespace eigengrain::spectrum
