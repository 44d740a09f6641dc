#pragma once

#include "eigengrain/assembly/clump_members.hpp"
#include "eigengrain/measures/ball_union.hpp"

#include "support/scenes.hpp"

#include <array>
#include <random>
#include <utility>
#include <vector>

/// Clumps for tests.
namespace eigengrain::test {

/// A shape of balls, with the mass properties of their union at a density, along its principal axes; its
/// frame is turned into them.
model::ClumpShape union_shape(const std::vector<Vec3>& at, const std::vector<double>& radius,
                              double density = 1);

/// Balls where they are asked for in the principal axes, with given mass properties.
model::ClumpShape given_shape(std::vector<Vec3> place, std::vector<double> radius, double mass,
                              const Vec3& inertia);

/// Two balls of radius one, their centres 2a apart along the first principal axis.
model::ClumpShape dumbbell(double a = 0.7);

/// Four balls without any symmetry.
model::ClumpShape odd_shape();

Quat random_orientation(std::mt19937_64& random);

/// Where a second clump is whose ball touches one of the first, along n from the first to the second, with an
/// overlap of this part of their radii.
model::ClumpStart beside(const model::ClumpShape& first, const model::ClumpStart& start,
                         std::size_t ball_first, const model::ClumpShape& second, const Quat& orientation,
                         std::size_t ball_second, const Vec3& n, double overlap = 1e-9);

/// An odd shape and a dumbbell that touch in one place, off the axes of both, otherwise turned at random.
SceneBuilder touching_pair(const Springs& springs, std::mt19937_64& random, double overlap = 1e-9);

/// A sink of tangents that adds to one dense matrix on the unknowns of bodies.
struct UnknownTangent {
  explicit UnknownTangent(const assembly::Unknowns& numbers)
      : unknowns(numbers),
        k(Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(numbers.size()),
                                static_cast<Eigen::Index>(numbers.size()))) {}
  void add(std::int32_t a, std::int32_t b, const Mat12& block) {
    const std::array<std::int32_t, 4> rows{unknowns.of(a)[0], unknowns.of(a)[1], unknowns.of(b)[0],
                                           unknowns.of(b)[1]};
    for (Eigen::Index i = 0; i < 4; ++i)
      for (Eigen::Index j = 0; j < 4; ++j) {
        const std::int32_t row = rows[static_cast<std::size_t>(i)];
        const std::int32_t column = rows[static_cast<std::size_t>(j)];
        if (row == assembly::Unknowns::none || column == assembly::Unknowns::none) continue;
        k.block<3, 3>(3 * row, 3 * column) += block.block<3, 3>(3 * i, 3 * j);
      }
  }
  const assembly::Unknowns& unknowns;
  Eigen::MatrixXd k;
};

/// Forces and moments on the numbered unknowns after the displacement h x from the committed state, of clumps
/// along their principal axes where they stand.
Eigen::VectorXd forces_on_unknowns(const System& s, const Eigen::VectorXd& x, double h);

/// -(f(h e) - f(-h e)) / 2h, column by column.
Eigen::MatrixXd numerical_stiffness(const System& s, double h);

}  // namespace eigengrain::test
