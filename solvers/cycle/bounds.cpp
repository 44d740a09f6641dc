#include "eigengrain/cycle/bounds.hpp"

#include "eigengrain/base/largest_eigenvalue.hpp"
#include "eigengrain/base/parallel.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace eigengrain::cycle {
namespace {

using contact::ContactElement;
using contact::no_body;

/// Relative error of a computed block eigenvalue: 6×6 sums over a body's contacts, a tridiagonalisation and
/// an iteration to 1e-13. Far below any difference that matters, and it keeps the bound on the safe side.
constexpr double rounding = 1e-12;

/// Diagonal of M_i^-½ of each body, zero where the component is fixed or does not exist.
std::vector<Vec6> inverse_sqrt_masses(const model::Bodies& bodies, const assembly::Unknowns& unknowns) {
  std::vector<Vec6> scale(bodies.position.size(), Vec6::Zero());
  for (std::int32_t body = 0; body < bodies.size(); ++body) {
    const auto i = static_cast<std::size_t>(body);
    for (int k = 0; k < 6; ++k) {
      const std::int32_t block = k < 3 ? unknowns.translation(body) : unknowns.rotation(body);
      if (block == assembly::Unknowns::none || bodies.fixed[i].component(k)) continue;
      scale[i][k] = 1.0 / std::sqrt(k < 3 ? bodies.mass[i] : bodies.inertia[i]);
    }
  }
  return scale;
}

/// K_c,ii of one end: B_iᵀ D B_i, lower triangle. The same for both ends but for the lever.
Mat6 end_block(const ContactElement& element, const Vec3& lever) {
  const Mat3 d = element.stiffness.translation(element.normal);
  const Mat3 skew = cross_matrix(lever);
  const Mat3 d_skew = d * skew;
  Mat6 block;
  block.topLeftCorner<3, 3>() = d;
  block.bottomLeftCorner<3, 3>() = -d_skew.transpose();
  block.bottomRightCorner<3, 3>() = element.stiffness.rotation(element.normal) - skew * d_skew;
  block.topRightCorner<3, 3>() = -d_skew;
  return block;
}

/// K of a body that touches its own image: B = B_a + B_b, of which only the rotation about the contact
/// survives, (R_a - R_b) × θ.
Mat6 self_block(const ContactElement& element) {
  const Mat3 skew = cross_matrix(element.lever_a - element.lever_b);
  Mat6 block = Mat6::Zero();
  block.bottomRightCorner<3, 3>() = -skew * element.stiffness.translation(element.normal) * skew;
  return block;
}

/// mean + √5 deviation of the six eigenvalues, from trace and norm: no eigenvalue is larger (Wolkowicz and
/// Styan, Linear Algebra Appl. 29:471, 1980).
double eigenvalue_bound(const Mat6& s) {
  const double mean = s.trace() / 6;
  return mean + std::sqrt(5 * std::max(0.0, s.squaredNorm() / 6 - mean * mean));
}

double timestep_of(double lambda) {
  return lambda > 0 ? 2.0 / std::sqrt(lambda) : std::numeric_limits<double>::infinity();
}

}  // namespace

double damped_timestep(double undamped_dt, double local_damping) {
  return undamped_dt / std::sqrt(1.0 + local_damping);
}

double diagonal_estimate(const model::Bodies& bodies, const assembly::Unknowns& unknowns,
                         std::span<const ContactElement> elements) {
  std::vector<Vec6> stiffness(bodies.position.size(), Vec6::Zero());
  for (const ContactElement& element : elements) {
    stiffness[static_cast<std::size_t>(element.a)] += end_block(element, element.lever_a).diagonal();
    if (element.b != no_body)
      stiffness[static_cast<std::size_t>(element.b)] += end_block(element, element.lever_b).diagonal();
  }
  const std::vector<Vec6> scale = inverse_sqrt_masses(bodies, unknowns);
  double largest = 0;
  for (std::size_t i = 0; i < stiffness.size(); ++i)
    largest = std::max(largest, scale[i].cwiseAbs2().cwiseProduct(stiffness[i]).maxCoeff());
  return largest > 0 ? 1.0 / std::sqrt(largest) : std::numeric_limits<double>::infinity();
}

BlockBound::BlockBound(const model::Bodies& bodies, const assembly::Unknowns& unknowns,
                       std::span<const ContactElement> elements)
    : elements_(elements),
      offsets_(bodies.position.size() + 1, 0),
      scale_(inverse_sqrt_masses(bodies, unknowns)),
      weight_(bodies.position.size(), 1.0) {
  const auto moves = [&](std::int32_t body) {
    return body != no_body && !scale_[static_cast<std::size_t>(body)].isZero(0);
  };
  const auto each_end = [&](const auto& act) {
    for (std::size_t c = 0; c < elements.size(); ++c) {
      const auto index = static_cast<std::int32_t>(c);
      const ContactElement& e = elements[c];
      if (e.a == e.b) {
        if (moves(e.a)) act(e.a, End{index, no_body, false, true});
        continue;
      }
      const bool a = moves(e.a);
      const bool b = moves(e.b);
      if (a) act(e.a, End{index, b ? e.b : no_body, false, false});
      if (b) act(e.b, End{index, a ? e.a : no_body, true, false});
    }
  };
  each_end([&](std::int32_t body, const End&) { ++offsets_[static_cast<std::size_t>(body) + 1]; });
  for (std::size_t i = 1; i < offsets_.size(); ++i) offsets_[i] += offsets_[i - 1];
  ends_.resize(static_cast<std::size_t>(offsets_.back()));
  std::vector<std::int64_t> next(offsets_.begin(), offsets_.end() - 1);
  each_end([&](std::int32_t body, const End& end) {
    ends_[static_cast<std::size_t>(next[static_cast<std::size_t>(body)]++)] = end;
  });
}

Mat6 BlockBound::block(std::int32_t body) const {
  const auto i = static_cast<std::size_t>(body);
  Mat6 sum = Mat6::Zero();
  for (std::int64_t k = offsets_[i]; k < offsets_[i + 1]; ++k) {
    const End& end = ends_[static_cast<std::size_t>(k)];
    const ContactElement& element = elements_[static_cast<std::size_t>(end.element)];
    if (end.whole) {
      sum += self_block(element);
      continue;
    }
    const double factor =
        end.other == no_body ? 1.0 : 1.0 + weight_[static_cast<std::size_t>(end.other)] / weight_[i];
    sum += factor * end_block(element, end.second ? element.lever_b : element.lever_a);
  }
  return scale_[i].asDiagonal() * sum * scale_[i].asDiagonal();
}

std::vector<double> BlockBound::block_eigenvalues() const {
  std::vector<double> lambda(weight_.size(), 0.0);
  for_each_index(static_cast<std::int64_t>(lambda.size()), [&](std::int64_t body) {
    const auto i = static_cast<std::size_t>(body);
    if (offsets_[i] != offsets_[i + 1])
      lambda[i] = largest_eigenvalue(block(static_cast<std::int32_t>(body)));
  });
  return lambda;
}

double BlockBound::timestep() const {
  constexpr std::int64_t chunk_size = 1024;
  const auto bodies = static_cast<std::int64_t>(weight_.size());
  std::vector<double> largest_of_chunk(static_cast<std::size_t>((bodies + chunk_size - 1) / chunk_size), 0.0);
  for_chunks(bodies, chunk_size, [&](std::int64_t begin, std::int64_t end, std::int64_t chunk) {
    double& largest = largest_of_chunk[static_cast<std::size_t>(chunk)];
    for (std::int64_t body = begin; body < end; ++body) {
      const Mat6 s = block(static_cast<std::int32_t>(body));
      // Few bodies can hold the largest eigenvalue; the others need none.
      if (eigenvalue_bound(s) > largest) largest = std::max(largest, largest_eigenvalue(s));
    }
  });
  const double largest =
      largest_of_chunk.empty() ? 0.0 : *std::max_element(largest_of_chunk.begin(), largest_of_chunk.end());
  return timestep_of(largest * (1.0 + rounding));
}

void BlockBound::sweep() {
  const std::vector<double> lambda = block_eigenvalues();
  // d_i <- d_i λ_i. A body whose block is zero moves nothing; its weight must only stay positive.
  for (std::size_t i = 0; i < weight_.size(); ++i)
    if (lambda[i] > 0) weight_[i] *= lambda[i];
  const double largest = weight_.empty() ? 1.0 : *std::max_element(weight_.begin(), weight_.end());
  for (double& d : weight_) d /= largest;
}

double block_bound(const model::Bodies& bodies, const assembly::Unknowns& unknowns,
                   std::span<const ContactElement> elements) {
  return BlockBound(bodies, unknowns, elements).timestep();
}

double scaled_block_bound(const model::Bodies& bodies, const assembly::Unknowns& unknowns,
                          std::span<const ContactElement> elements, int sweeps) {
  BlockBound bound(bodies, unknowns, elements);
  for (int sweep = 0; sweep < sweeps; ++sweep) bound.sweep();
  return bound.timestep();
}

}  // namespace eigengrain::cycle
