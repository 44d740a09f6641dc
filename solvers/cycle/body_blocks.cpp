#include "body_blocks.hpp"

#include "eigengrain/base/largest_eigenvalue.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace eigengrain::cycle {
namespace {

using assembly::LinearSystem;
using contact::ContactElement;
using contact::ContactStiffness;
using contact::no_body;

/// Levers that are along n but for this part count as along n: far less than what rounding() adds.
constexpr double along_normal = 1e-13;

/// No eigenvalue of a symmetric positive semidefinite S is larger: mean + √5 deviation, from trace and norm
/// (Wolkowicz and Styan, Linear Algebra Appl. 29:471, 1980). What cancellation can hide in a nearly isotropic
/// S is added to it.
double eigenvalue_bound(double trace, double squared_norm) {
  constexpr double hidden = 64 * std::numeric_limits<double>::epsilon();
  const double mean = trace / 6;
  const double square = squared_norm / 6;
  return mean + std::sqrt(5 * (std::max(0.0, square - mean * mean) + hidden * square));
}

const Vec3& lever(const ContactElement& element, std::int32_t end) {
  return end % 2 == 0 ? element.lever_a : element.lever_b;
}

bool radial(const Vec3& lever, const Vec3& n) {
  return (lever - lever.dot(n) * n).squaredNorm() <= along_normal * along_normal * lever.squaredNorm();
}

bool isotropic(const Vec6& scale) {
  const auto same = [&](int k) { return scale[k] == scale[k + 1] && scale[k] == scale[k + 2]; };
  return same(0) && same(3);
}

/// A sum of ends with levers r n:
///   K_uu = a 1 + Σ..nnᵀ, K_θθ = b 1 + Σ..nnᵀ, K_uθ = -[c]×
struct RadialSum {
  double a = 0;
  double b = 0;
  Vec3 c = Vec3::Zero();
  std::array<double, 6> uu{};  ///< xx, yy, zz, xy, xz, yz
  std::array<double, 6> tt{};

  void add(const ContactElement& element, const Vec3& lever, const ContactStiffness& k, double factor) {
    const Vec3& n = element.normal;
    const double r = lever.dot(n);
    const double shear = factor * k.shear;
    const double turning = r * r * shear + factor * k.bending;
    const double along = factor * (k.normal - k.shear);
    const double twist = factor * k.twist - turning;
    a += shear;
    b += turning;
    c += r * shear * n;
    const std::array<double, 6> nn{n.x() * n.x(), n.y() * n.y(), n.z() * n.z(),
                                   n.x() * n.y(), n.x() * n.z(), n.y() * n.z()};
    for (std::size_t k6 = 0; k6 < 6; ++k6) uu[k6] += along * nn[k6];
    for (std::size_t k6 = 0; k6 < 6; ++k6) tt[k6] += twist * nn[k6];
  }

  static Mat3 matrix(double diagonal, const std::array<double, 6>& s) {
    Mat3 m;
    m << diagonal + s[0], s[3], s[4], s[3], diagonal + s[1], s[5], s[4], s[5], diagonal + s[2];
    return m;
  }
  Mat6 block() const {
    const Mat3 skew = cross_matrix(c);
    Mat6 m;
    m << matrix(a, uu), -skew, skew, matrix(b, tt);
    return m;
  }
  static double trace(double diagonal, const std::array<double, 6>& s) {
    return 3 * diagonal + s[0] + s[1] + s[2];
  }
  static double square(double diagonal, const std::array<double, 6>& s) {
    double sum = 0;
    for (std::size_t k = 0; k < 3; ++k) sum += (diagonal + s[k]) * (diagonal + s[k]);
    for (std::size_t k = 3; k < 6; ++k) sum += 2 * s[k] * s[k];
    return sum;
  }
  /// Of the block scaled by 1/m, 1/I.
  double bound(double per_mass, double per_inertia) const {
    const double total = per_mass * trace(a, uu) + per_inertia * trace(b, tt);
    const double norm = per_mass * per_mass * square(a, uu) + 4 * per_mass * per_inertia * c.squaredNorm() +
                        per_inertia * per_inertia * square(b, tt);
    return eigenvalue_bound(total, norm);
  }
};

/// Any ends.
struct FullSum {
  Mat6 sum = Mat6::Zero();

  void add(const ContactElement& element, const Vec3& lever, const ContactStiffness& k, double factor) {
    ContactElement end = element;
    end.stiffness = k;
    sum += factor * contact::end_block(end, lever);
  }
  void add_self(const ContactElement& element, const ContactStiffness& k) {
    ContactElement own = element;
    own.stiffness = k;
    sum += contact::self_block(own);
  }
  const Mat6& block() const { return sum; }
};

}  // namespace

BodyBlocks::BodyBlocks(const LinearSystem& system, std::span<const double> mass_divisor)
    : system_(system),
      scale_(system.inverse_sqrt_mass_of_bodies()),
      divisor_(mass_divisor.begin(), mass_divisor.end()) {
  divisor_.resize(scale_.size(), 1.0);
  moves_.reserve(scale_.size());
  simple_.reserve(scale_.size());
  for (const Vec6& scale : scale_) {
    moves_.push_back(static_cast<char>(!scale.isZero(0)));
    simple_.push_back(static_cast<char>(isotropic(scale)));
  }
  std::vector<std::int32_t> body_of_end;
  body_of_end.reserve(2 * system.elements.size());
  for (const ContactElement& e : system.elements) {
    body_of_end.push_back(e.a);
    // A body that touches its own image has the contact once, as a whole.
    body_of_end.push_back(e.a == e.b ? no_body : e.b);
    if (e.a == e.b || !radial(e.lever_a, e.normal)) simple_[e.a] = 0;
    if (e.b != no_body && !radial(e.lever_b, e.normal)) simple_[e.b] = 0;
  }
  ends_ = group_by_row(system.unknowns.bodies(), body_of_end);
  for (std::size_t i = 0; i < system.nodal.bound.size(); ++i)
    if (!system.nodal.bound[i].isZero(0)) simple_[i] = 0;
}

ContactStiffness BodyBlocks::stiffness(std::int32_t contact, double mu) const {
  ContactStiffness k = system_.elements[static_cast<std::size_t>(contact)].stiffness;
  if (mu == 0) return k;
  k.normal += mu * system_.damping[static_cast<std::size_t>(contact)].normal;
  k.shear += mu * system_.damping[static_cast<std::size_t>(contact)].shear;
  return k;
}

template <class Sum>
Sum BodyBlocks::sum(std::int32_t body, std::span<const double> weight, double mu) const {
  Sum sum;
  const double per_own = 1 / weight[body];
  for (const std::int32_t end : ends_.links(body)) {
    const ContactElement& element = system_.elements[static_cast<std::size_t>(end / 2)];
    if constexpr (std::is_same_v<Sum, FullSum>)
      if (element.a == element.b) {
        sum.add_self(element, stiffness(end / 2, mu));
        continue;
      }
    const std::int32_t j = other(end);
    const double factor = j == no_body ? 1.0 : 1.0 + weight[j] * per_own;
    sum.add(element, lever(element, end), stiffness(end / 2, mu), factor);
  }
  return sum;
}

Mat6 BodyBlocks::scaled(std::int32_t body, const Mat6& block) const {
  const Vec6& s = scale_[body];
  const double d = divisor_[body];
  if (system_.unknowns.axes(body) == nullptr) return d * (s.asDiagonal() * block * s.asDiagonal());
  return d * (s.asDiagonal() * system_.unknowns.in_own_axes(body, body, block) * s.asDiagonal());
}

Mat6 BodyBlocks::nodal(std::int32_t body, double mu) const {
  if (system_.nodal.bound.empty()) return Mat6::Zero();
  const auto i = static_cast<std::size_t>(body);
  if (mu == 0 || system_.nodal.viscous_bound.empty()) return system_.nodal.bound[i];
  return system_.nodal.bound[i] + mu * system_.nodal.viscous_bound[i];
}

Mat6 BodyBlocks::block(std::int32_t body, std::span<const double> weight, double mu) const {
  if (simple_[body] != 0) return scaled(body, sum<RadialSum>(body, weight, mu).block());
  return scaled(body, sum<FullSum>(body, weight, mu).block() + nodal(body, mu));
}

BodyBlocks::Parts BodyBlocks::parts(std::int32_t body, std::span<const double> weight, double mu) const {
  FullSum own;
  FullSum others;
  for (const std::int32_t end : ends_.links(body)) {
    const ContactElement& element = system_.elements[static_cast<std::size_t>(end / 2)];
    const ContactStiffness k = stiffness(end / 2, mu);
    if (element.a == element.b) {
      own.add_self(element, k);
      continue;
    }
    own.add(element, lever(element, end), k, 1.0);
    const std::int32_t j = other(end);
    if (j != no_body) others.add(element, lever(element, end), k, weight[j]);
  }
  return {scaled(body, own.block() + nodal(body, mu)), scaled(body, others.block())};
}

double BodyBlocks::energy(std::int32_t body, std::int32_t end, const Vec6& x, double mu) const {
  const ContactElement& element = system_.elements[static_cast<std::size_t>(end / 2)];
  const ContactStiffness k = stiffness(end / 2, mu);
  const Vec6 moved = scale_[body].cwiseProduct(x);
  const Mat3* axes = system_.unknowns.axes(body);
  const Vec3 turn = axes == nullptr ? Vec3(moved.tail<3>()) : Vec3(*axes * moved.tail<3>());
  const Vec3 displacement = moved.head<3>() + turn.cross(lever(element, end));
  const double along = displacement.dot(element.normal);
  const double about = turn.dot(element.normal);
  return divisor_[body] * (k.normal * along * along + k.shear * (displacement.squaredNorm() - along * along) +
                           k.twist * about * about + k.bending * (turn.squaredNorm() - about * about));
}

double BodyBlocks::rounding(std::int32_t body) const {
  return 1e-12 + 16 * std::numeric_limits<double>::epsilon() * static_cast<double>(ends(body).size());
}

double BodyBlocks::bound(std::int32_t body, std::span<const double> weight, double mu) const {
  const double on_safe_side = 1 + rounding(body);
  if (simple_[body] != 0)
    return on_safe_side * divisor_[body] *
           sum<RadialSum>(body, weight, mu)
               .bound(scale_[body][0] * scale_[body][0], scale_[body][3] * scale_[body][3]);
  const Mat6 s = block(body, weight, mu);
  return on_safe_side * eigenvalue_bound(s.trace(), s.squaredNorm());
}

double BodyBlocks::eigenvalue(std::int32_t body, std::span<const double> weight, double mu) const {
  return (1 + rounding(body)) * largest_eigenvalue(block(body, weight, mu));
}

}  // namespace eigengrain::cycle
