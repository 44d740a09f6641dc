#include "timestep/estimates/element_bounds.hpp"

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

/// P Pᵀ of both ends of a contact: its compliance against a force at the contact, times stiffness. Of two
/// balls it is diagonal, which spares an eigenvalue problem a sweep.
struct Element {
  std::array<std::int32_t, 2> body{no_body, no_body};
  std::array<double, 2> alone{};  ///< λ_max of each end by itself
  std::array<Vec6, 2> diagonal{Vec6::Zero(), Vec6::Zero()};
  std::int32_t whole = -1;  ///< where the matrices are that are not diagonal, or -1
};

struct Elements {
  std::vector<Element> list;
  std::vector<std::array<Mat6, 2>> whole;
  std::int32_t bodies = 0;
};

/// Off-diagonal terms that rounding alone can have made; they are added to the diagonal (Gershgorin).
Vec6 rounded_diagonal(const Mat6& m) {
  return m.cwiseAbs().rowwise().sum();
}
bool is_nearly_diagonal(const Mat6& m) {
  const double off = (m - Mat6(m.diagonal().asDiagonal())).cwiseAbs().maxCoeff();
  return off <= 1e-14 * m.diagonal().maxCoeff();
}

Elements elements_of(const ContactFactors& factors) {
  Elements result{.list = {}, .whole = {}, .bodies = factors.bodies()};
  result.list.reserve(static_cast<std::size_t>(factors.contacts()));
  for (const contact::ContactElement& contact : factors.system().elements) {
    const ContactFactors::Ends ends = factors.of(contact);
    const std::array<Mat6, 2> block{ends.a * ends.a.transpose(), ends.b * ends.b.transpose()};
    Element element{.body = factors.bodies_of(contact)};
    const bool diagonal = is_nearly_diagonal(block[0]) && is_nearly_diagonal(block[1]);
    if (!diagonal) {
      element.whole = static_cast<std::int32_t>(result.whole.size());
      result.whole.push_back(block);
    }
    for (std::size_t k = 0; k < 2; ++k) {
      element.diagonal[k] = rounded_diagonal(block[k]);
      element.alone[k] = diagonal ? element.diagonal[k].maxCoeff() : largest_eigenvalue(block[k]);
    }
    result.list.push_back(element);
  }
  return result;
}

/// Eigenvalue of a contact that has 1/factor[k] of the mass of its end k.
double eigenvalue(const Elements& elements, const Element& element, const std::array<double, 2>& factor) {
  if (element.whole < 0)
    return (factor[0] * element.diagonal[0] + factor[1] * element.diagonal[1]).maxCoeff();
  const auto& block = elements.whole[static_cast<std::size_t>(element.whole)];
  return largest_eigenvalue(factor[0] * block[0] + factor[1] * block[1]);
}

/// [elements] eigenvalues where part[e][k] are shares of the mass that need not add up to one.
std::vector<double> eigenvalues(const Elements& elements, const std::vector<std::array<double, 2>>& part) {
  std::vector<double> sum(static_cast<std::size_t>(elements.bodies), 0.0);
  for (std::size_t e = 0; e < part.size(); ++e)
    for (std::size_t k = 0; k < 2; ++k)
      if (const std::int32_t body = elements.list[e].body[k]; body != no_body) sum[body] += part[e][k];
  std::vector<double> lambda(part.size());
  for_each_index(static_cast<std::int64_t>(part.size()), [&](std::int64_t e) {
    std::array<double, 2> factor{};
    for (std::size_t k = 0; k < 2; ++k)
      if (const std::int32_t body = elements.list[e].body[k]; body != no_body && part[e][k] > 0)
        factor[k] = sum[body] / part[e][k];
    lambda[e] = eigenvalue(elements, elements.list[e], factor) * (1 + rounding_margin);
  });
  return lambda;
}

double step_of_largest(const std::vector<double>& lambda) {
  double largest = 0;
  for (const double value : lambda) largest = larger(largest, value);
  return step_of(largest);
}

}  // namespace

double element_bound(const ContactFactors& factors, MassSplit split) {
  const Elements elements = elements_of(factors);
  std::vector<std::array<double, 2>> part(elements.list.size(), {1.0, 1.0});
  // An end that resists nothing takes no mass.
  for (std::size_t e = 0; e < part.size(); ++e)
    for (std::size_t k = 0; k < 2; ++k)
      if (split == MassSplit::by_stiffness || elements.list[e].alone[k] == 0)
        part[e][k] = elements.list[e].alone[k];
  return step_of_largest(eigenvalues(elements, part));
}

double best_element_bound(const ContactFactors& factors, int sweeps) {
  const Elements elements = elements_of(factors);
  std::vector<double> weight(elements.list.size(), 1.0);
  std::vector<std::array<double, 2>> part(elements.list.size());
  double best = 0;
  for (int sweep = 0; sweep <= sweeps; ++sweep) {
    for (std::size_t e = 0; e < part.size(); ++e)
      for (std::size_t k = 0; k < 2; ++k) part[e][k] = std::sqrt(elements.list[e].alone[k]) * weight[e];
    const std::vector<double> lambda = eigenvalues(elements, part);
    best = std::max(best, step_of_largest(lambda));
    double largest = 0;
    for (std::size_t e = 0; e < weight.size(); ++e) {
      if (lambda[e] > 0) weight[e] *= lambda[e];
      largest = std::max(largest, weight[e]);
    }
    // Never zero: a contact without mass would count for nothing.
    for (double& w : weight) w = std::max(w / largest, 1e-100);
  }
  return best;
}

}  // namespace eigengrain::timestep
