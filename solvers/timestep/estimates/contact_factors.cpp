#include "timestep/estimates/contact_factors.hpp"

#include <cmath>

namespace eigengrain::timestep {
namespace {

using contact::ContactElement;
using contact::no_body;

/// n and two unit vectors across it, as rows.
Mat3 triad(const Vec3& n) {
  const Vec3 across = n.unitOrthogonal();
  Mat3 rows;
  rows << n.transpose(), across.transpose(), n.cross(across).transpose();
  return rows;
}

/// D^½ in the frame of the contact, times the turn into it.
Mat6 weighted_rows(const ContactElement& element) {
  const Mat3 frame = triad(element.normal);
  const contact::ContactStiffness& k = element.stiffness;
  Mat6 rows = Mat6::Zero();
  rows.topLeftCorner<3, 3>() = Vec3(k.normal, k.shear, k.shear).cwiseSqrt().asDiagonal() * frame;
  rows.bottomRightCorner<3, 3>() = Vec3(k.twist, k.bending, k.bending).cwiseSqrt().asDiagonal() * frame;
  return rows;
}

/// B of the second end: (δ, φ) = (u - [R]× θ, θ). That of the first is its negative.
Mat6 displacement_of_end(const Vec3& lever) {
  Mat6 b = Mat6::Identity();
  b.topRightCorner<3, 3>() = -cross_matrix(lever);
  return b;
}

}  // namespace

ContactFactors::ContactFactors(const assembly::LinearSystem& system)
    : system_(system), scale_(system.inverse_sqrt_mass_of_bodies()) {}

std::array<std::int32_t, 2> ContactFactors::bodies_of(const ContactElement& element) const {
  const auto moving = [&](std::int32_t body) {
    return body != no_body && !scale_[body].isZero(0) ? body : no_body;
  };
  return {moving(element.a), element.a == element.b ? no_body : moving(element.b)};
}

/// From (u, θ) along the axes of space to the scaled unknowns of the body.
Mat6 ContactFactors::on_unknowns(std::int32_t body, Mat6 factor) const {
  if (const Mat3* axes = system_.unknowns.axes(body); axes != nullptr)
    factor.rightCols<3>() = (factor.rightCols<3>() * *axes).eval();
  return factor * scale_[body].asDiagonal();
}

ContactFactors::Ends ContactFactors::of(const ContactElement& element) const {
  Ends ends;
  const Mat6 rows = weighted_rows(element);
  const Mat6 first = rows * displacement_of_end(element.lever_a);
  const Mat6 second = rows * displacement_of_end(element.lever_b);
  const auto [a, b] = bodies_of(element);
  // On one set of unknowns only (R_a - R_b) × θ is left.
  if (a != no_body) ends.a = on_unknowns(a, element.a == element.b ? Mat6(first - second) : first);
  if (b != no_body) ends.b = on_unknowns(b, second);
  return ends;
}

}  // namespace eigengrain::timestep
