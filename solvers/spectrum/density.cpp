#include "eigengrain/spectrum/density.hpp"

#include "eigengrain/assembly/product.hpp"
#include "eigengrain/base/error.hpp"
#include "eigengrain/base/timer.hpp"
#include "eigengrain/cycle/bounds.hpp"

#include <Eigen/Core>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <random>

namespace eigengrain::spectrum {
namespace {

using assembly::StiffnessProduct;
using std::numbers::pi;

/// Sweeps of the bound: the nearer it is to λ_max, the finer the resolution.
constexpr int sweeps = 10;
constexpr int most_moments = 100000;

/// Jackson's damping of moment n out of `moments` (Weiße et al., eq. 71).
double jackson(int n, int moments) {
  const double q = pi / (moments + 1);
  return ((moments - n + 1) * std::cos(q * n) + std::sin(q * n) / std::tan(q)) / (moments + 1);
}

/// t of an angular frequency over the root of the bound: ω = √λ_b cos(t/2).
double angle(double fraction) {
  return 2 * std::acos(std::clamp(fraction, 0.0, 1.0));
}

/// The integral of the density over each bin, from its moments; all bins together give μ_0.
std::vector<double> integrals(const std::vector<double>& moment, int moments,
                              const std::vector<double>& t_of_edge) {
  std::vector<double> damped(static_cast<std::size_t>(moments));
  for (int n = 0; n < moments; ++n) damped[n] = jackson(n, moments) * moment[n];
  // From t to π, where λ = 0.
  const auto below = [&](double t) {
    double sum = damped[0] * (pi - t);
    for (int n = 1; n < moments; ++n) sum -= 2 * damped[n] * std::sin(n * t) / n;
    return sum / pi;
  };
  std::vector<double> result;
  double last = below(t_of_edge.front());
  for (std::size_t k = 1; k < t_of_edge.size(); ++k) {
    const double next = below(t_of_edge[k]);
    result.push_back(next - last);
    last = next;
  }
  return result;
}

std::vector<double> angles(const std::vector<double>& edge, double bound) {
  std::vector<double> result;
  for (const double omega : edge) result.push_back(angle(omega / std::sqrt(bound)));
  return result;
}

/// Signs at free components.
Eigen::VectorXd random_signs(std::span<const double> scale, std::mt19937_64& random) {
  Eigen::VectorXd result(static_cast<Eigen::Index>(scale.size()));
  for (std::size_t k = 0; k < scale.size(); ++k)
    result[static_cast<Eigen::Index>(k)] = scale[k] > 0 ? ((random() >> 63U) != 0 ? 1.0 : -1.0) : 0.0;
  return result;
}

/// z·T_n(Ã)z for n < moments, by z·T_2n z = 2|T_n z|² - z·z and z·T_2n+1 z = 2 T_n z·T_n+1 z - z·T_1 z.
/// Nothing after an interrupt.
std::optional<std::vector<double>> moments_of(StiffnessProduct& product, double bound,
                                              const Eigen::VectorXd& z, const DensityOptions& options) {
  const auto size = static_cast<std::size_t>(z.size());
  std::vector<double> moment(static_cast<std::size_t>(options.moments), 0.0);
  Eigen::VectorXd image(z.size());
  // Ã x = (2/λ_b) A x - x
  const auto apply = [&](const Eigen::VectorXd& x) {
    product.apply({x.data(), size}, {image.data(), size});
    image = (2 / bound) * image - x;
  };
  Eigen::VectorXd last = z;
  apply(z);
  Eigen::VectorXd now = image;
  const double mu0 = z.squaredNorm();
  const double mu1 = z.dot(now);
  moment[0] = mu0;
  moment[1] = mu1;
  for (int n = 1; 2 * n < options.moments; ++n) {
    if (options.interrupted && options.interrupted()) return std::nullopt;
    moment[2 * n] = 2 * now.squaredNorm() - mu0;
    if (2 * n + 1 == options.moments) break;
    apply(now);
    last = 2 * image - last;
    std::swap(last, now);
    moment[2 * n + 1] = 2 * now.dot(last) - mu1;
  }
  return moment;
}

void check(const DensityOptions& options) {
  const auto require = [](bool good, const char* name, std::int64_t value, const char* wanted) {
    if (!good) throw InputError(fmt::format("density of states: {} {}; {} is wanted", name, value, wanted));
  };
  require(options.moments >= 8 && options.moments <= most_moments, "moments", options.moments, "8 to 100000");
  require(options.vectors >= 2, "vectors", options.vectors, "a number from 2 up, for errors to be known,");
  require(options.bins >= 1 && options.bins <= options.moments, "bins", options.bins,
          "a number from 1 up to that of the moments");
}

}  // namespace

std::vector<double> smeared(double lambda, double bound, int moments, const std::vector<double>& edge) {
  const double t = angle(std::sqrt(std::max(lambda, 0.0) / bound));
  std::vector<double> moment(static_cast<std::size_t>(moments));
  for (int n = 0; n < moments; ++n) moment[n] = std::cos(n * t);
  return integrals(moment, moments, angles(edge, bound));
}

Density density_of_states(const assembly::LinearSystem& system, const DensityOptions& options) {
  check(options);
  const Stopwatch watch;
  const std::vector<double> scale = system.inverse_sqrt_mass();
  Density result;
  result.modes = std::ranges::count_if(scale, [](double s) { return s > 0; });
  const double step = cycle::scaled_block_bound(system, sweeps);
  if (result.modes == 0 || !std::isfinite(step)) return result;
  const double bound = 4 / (step * step);
  for (int k = 0; k <= options.bins; ++k) result.edge.push_back(std::sqrt(bound) * k / options.bins);
  result.resolution = 0.5 * std::sqrt(bound) * pi / options.moments;
  const std::vector<double> t = angles(result.edge, bound);

  StiffnessProduct product(system.unknowns, system.parts(), scale);
  std::mt19937_64 random(options.seed);
  const auto bins = static_cast<std::size_t>(options.bins);
  std::vector<double> sum(bins, 0.0);
  std::vector<double> squares(bins, 0.0);
  std::vector<double> coarse(bins, 0.0);  // with half of the moments
  int done = 0;
  for (; done < options.vectors; ++done) {
    const auto moment = moments_of(product, bound, random_signs(scale, random), options);
    if (!moment) break;
    const std::vector<double> found = integrals(*moment, options.moments, t);
    const std::vector<double> half = integrals(*moment, options.moments / 2, t);
    for (std::size_t k = 0; k < bins; ++k) {
      sum[k] += found[k];
      squares[k] += found[k] * found[k];
      coarse[k] += half[k];
    }
  }
  result.complete = done == options.vectors;
  result.products = product.products();
  if (done >= 2)
    for (std::size_t k = 0; k < bins; ++k) {
      const double mean = sum[k] / done;
      const double variance = std::max(0.0, squares[k] / done - mean * mean) / (done - 1);
      const double blur = coarse[k] / done - mean;
      result.count.push_back(mean);
      result.error.push_back(std::sqrt(variance + blur * blur));
    }
  result.seconds = watch.seconds();
  return result;
}

}  // namespace eigengrain::spectrum
