#include "timestep/estimates/matrix_bounds.hpp"

#include "eigengrain/cycle/step_of.hpp"

#include <vector>

namespace eigengrain::timestep {
namespace {

using cycle::larger;
using cycle::step_of;

using contact::no_body;

/// d [bodies]. Blocks of two contacts between the same two bodies are summed by their absolute values, which
/// is a bound too.
double gershgorin(const ContactFactors& factors, const std::vector<Vec6>& d) {
  std::vector<Mat6> own(static_cast<std::size_t>(factors.bodies()), Mat6::Zero());
  std::vector<Vec6> row_sum(own.size(), Vec6::Zero());
  for (const contact::ContactElement& element : factors.system().elements) {
    const auto [a, b] = factors.bodies_of(element);
    const ContactFactors::Ends ends = factors.of(element);
    if (a != no_body) own[a] += ends.a.transpose() * ends.a;
    if (b != no_body) own[b] += ends.b.transpose() * ends.b;
    if (a == no_body || b == no_body) continue;
    const Mat6 coupling = (ends.a.transpose() * ends.b).cwiseAbs();
    row_sum[a] += coupling * d[b];
    row_sum[b] += coupling.transpose() * d[a];
  }
  double largest = 0;
  for (std::size_t i = 0; i < own.size(); ++i) {
    const Vec6 sums = (row_sum[i] + own[i].cwiseAbs() * d[i]).cwiseQuotient(d[i]);
    for (const double sum : sums) largest = larger(largest, sum);
  }
  return step_of(largest * (1 + rounding_margin));
}

}  // namespace

double gershgorin_bound(const ContactFactors& factors, const model::Bodies& bodies) {
  const assembly::Unknowns& unknowns = factors.system().unknowns;
  // M^½ of (u, Rθ): √m and √I/R.
  std::vector<Vec6> d(static_cast<std::size_t>(factors.bodies()), Vec6::Ones());
  for (std::int32_t block = 0; block < unknowns.blocks(); ++block) {
    const std::int32_t body = unknowns.body(block);
    const std::int32_t clump = bodies.clumps.of(body);
    const double radius = clump == model::Clumps::none
                              ? bodies.radius[static_cast<std::size_t>(body)]
                              : bodies.clumps.radius[static_cast<std::size_t>(clump)];
    const Vec3 root = Eigen::Map<const Vec3>(&factors.system().mass[std::size_t{3} * block]).cwiseSqrt();
    if (unknowns.is_rotation(block))
      d[body].tail<3>() = root / radius;
    else
      d[body].head<3>() = root;
  }
  return gershgorin(factors, d);
}

double symmetric_gershgorin_bound(const ContactFactors& factors) {
  return gershgorin(factors, std::vector<Vec6>(static_cast<std::size_t>(factors.bodies()), Vec6::Ones()));
}

}  // namespace eigengrain::timestep
