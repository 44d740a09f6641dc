#include "timestep/estimates/contact_space.hpp"

#include "eigengrain/base/adjacency.hpp"
#include "eigengrain/base/largest_eigenvalue.hpp"
#include "eigengrain/base/parallel.hpp"
#include "eigengrain/cycle/step_of.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace eigengrain::timestep {
namespace {

using cycle::larger;
using cycle::step_of;

using contact::no_body;

/// Spectral norm, raised by more than it can err by: the largest root of the characteristic polynomial of
/// X Xᵀ by the cosine of a third of an angle.
double norm_bound(const Mat3& x) {
  const Mat3 s = x * x.transpose();
  const double mean = s.trace() / 3;
  const Mat3 rest = s - mean * Mat3::Identity();
  const double spread = std::sqrt(rest.squaredNorm() / 6);
  if (!(spread > 0)) return std::sqrt(mean) * (1 + rounding_margin);
  const double half_determinant = std::clamp((rest / spread).determinant() / 2, -1.0, 1.0);
  return std::sqrt(mean + 2 * spread * std::cos(std::acos(half_determinant) / 3)) * (1 + 1e-7);
}
double norm_bound(const Mat6& x) {
  return std::sqrt(largest_eigenvalue(x * x.transpose())) * (1 + rounding_margin);
}

/// Contacts with the norms of their blocks with others, compressed rows.
struct NormMatrix {
  std::vector<double> own;  ///< |G_cc|
  Adjacency others;
  std::vector<double> norm;  ///< beside others.targets
};

/// size  3 where no contact carries a moment, else 6: the rows of P that are not zero
template <int size>
NormMatrix norms_of(const ContactFactors& factors) {
  using Block = Eigen::Matrix<double, size, size>;
  const std::vector<contact::ContactElement>& elements = factors.system().elements;
  std::vector<Eigen::Matrix<double, size, 6>> end(2 * elements.size());
  std::vector<std::int32_t> body_of_end(2 * elements.size(), no_body);
  NormMatrix result;
  result.own.resize(elements.size());
  for_each_index(factors.contacts(), [&](std::int64_t c) {
    const ContactFactors::Ends ends = factors.of(elements[c]);
    const auto bodies = factors.bodies_of(elements[c]);
    end[2 * c] = ends.a.template topRows<size>();
    end[2 * c + 1] = ends.b.template topRows<size>();
    body_of_end[2 * c] = bodies[0];
    body_of_end[2 * c + 1] = bodies[1];
    const Block own = end[2 * c] * end[2 * c].transpose() + end[2 * c + 1] * end[2 * c + 1].transpose();
    Mat6 padded = Mat6::Zero();
    padded.topLeftCorner<size, size>() = own;
    result.own[c] = largest_eigenvalue(padded) * (1 + rounding_margin);
  });
  const Adjacency ends = group_by_row(factors.bodies(), body_of_end);
  const auto others_at = [&](std::int64_t e) {
    return body_of_end[e] == no_body ? 0 : static_cast<std::int64_t>(ends.links(body_of_end[e]).size()) - 1;
  };
  result.others.offsets.reserve(elements.size() + 1);
  for (std::int64_t c = 0; c < factors.contacts(); ++c)
    result.others.offsets.push_back(result.others.offsets.back() + others_at(2 * c) + others_at(2 * c + 1));
  result.others.targets.resize(static_cast<std::size_t>(result.others.offsets.back()));
  result.norm.resize(result.others.targets.size());
  for_each_index(factors.contacts(), [&](std::int64_t c) {
    std::int64_t at = result.others.offsets[c];
    for (const std::int64_t mine : {2 * c, 2 * c + 1}) {
      if (body_of_end[mine] == no_body) continue;
      for (const std::int32_t other : ends.links(body_of_end[mine])) {
        if (other == mine) continue;
        result.others.targets[at] = other / 2;
        result.norm[at++] = norm_bound(Block(end[mine] * end[other].transpose()));
      }
    }
  });
  return result;
}

bool carries_moments(const assembly::LinearSystem& system) {
  return std::any_of(system.elements.begin(), system.elements.end(), [](const auto& element) {
    return element.stiffness.twist > 0 || element.stiffness.bending > 0;
  });
}

}  // namespace

double contact_space_bound(const ContactFactors& factors, int sweeps) {
  const NormMatrix matrix = carries_moments(factors.system()) ? norms_of<6>(factors) : norms_of<3>(factors);
  std::vector<double> weight(matrix.own.size(), 1.0);
  std::vector<double> image(weight.size());
  double best = 0;
  for (int sweep = 0; sweep <= sweeps; ++sweep) {
    for_each_index(static_cast<std::int64_t>(image.size()), [&](std::int64_t c) {
      double sum = matrix.own[c] * weight[c];
      for (std::int64_t k = matrix.others.offsets[c]; k < matrix.others.offsets[c + 1]; ++k)
        sum += matrix.norm[k] * weight[matrix.others.targets[k]];
      image[c] = sum;
    });
    double lambda = 0;
    double largest = 0;
    for (std::size_t c = 0; c < image.size(); ++c) {
      lambda = larger(lambda, image[c] / weight[c]);
      largest = larger(largest, image[c]);
    }
    best = std::max(best, step_of(lambda * (1 + rounding_margin)));
    if (!(largest > 0)) break;
    // A weight must only be positive.
    for (std::size_t c = 0; c < image.size(); ++c) weight[c] = std::max(image[c] / largest, 1e-100);
  }
  return best;
}

}  // namespace eigengrain::timestep
