#include "eigengrain/assembly/nodal_stiffness.hpp"

#include "eigengrain/assembly/acting.hpp"
#include "eigengrain/assembly/clump_members.hpp"
#include "eigengrain/assembly/forces.hpp"
#include "eigengrain/assembly/scatter.hpp"
#include "eigengrain/contact/consistent_tangent.hpp"

#include "dashpots.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace eigengrain::assembly {
namespace {

using RowMajor3 = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

/// What the 12×12 of a contact between a ball and the point of a skin is to the ball and the corners.
class SkinBlocks {
 public:
  /// The bodies: 0 the ball, 1 to 3 the corners.
  static constexpr int bodies = 4;
  SkinBlocks(std::int32_t ball, const contact::SkinPoint& point, const Mat12& k) : point_(point), k_(k) {
    body_ = {ball, point.body[0], point.body[1], point.body[2]};
  }
  std::int32_t body(int i) const { return body_[static_cast<std::size_t>(i)]; }
  /// On (u, θ) of two of them; a corner has no θ.
  Mat6 block(int i, int j) const {
    if (i == 0 && j == 0) return k_.topLeftCorner<6, 6>();
    Mat6 result = Mat6::Zero();
    if (i == 0)
      result.leftCols<3>() = k_.topRightCorner<6, 6>() * motion(j);
    else if (j == 0)
      result.topRows<3>() = motion(i).transpose() * k_.bottomLeftCorner<6, 6>();
    else
      result.topLeftCorner<3, 3>() = motion(i).transpose() * k_.bottomRightCorner<6, 6>() * motion(j);
    return result;
  }

 private:
  /// (u_P, θ_P) of u_i of a corner.
  Eigen::Matrix<double, 6, 3> motion(int i) const {
    const auto corner = static_cast<std::size_t>(i - 1);
    Eigen::Matrix<double, 6, 3> result;
    result << point_.weight[corner] * Mat3::Identity(), point_.turn[corner];
    return result;
  }

  contact::SkinPoint point_;
  Mat12 k_;
  std::array<std::int32_t, 4> body_{};
};

/// The whole 12×12 of an element whose second end has no body of its own.
Mat12 stiffness_of(const contact::ContactElement& element) {
  contact::ContactElement both = element;
  both.b = element.a + 1;  // any other
  return contact::stiffness_matrix(both);
}

/// The 12×12 of a ball of a clump on (u, θ) of the clump.
Mat12 of_holder(const model::Bodies& bodies, std::int32_t ball, const Mat12& k) {
  if (bodies.clumps.of(ball) == model::Clumps::none) return k;
  Mat12 carry = Mat12::Identity();
  carry.block<3, 3>(0, 3) = -cross_matrix(lever_of(bodies, ball));
  return carry.transpose() * k * carry;
}

bool can_move(const Unknowns& unknowns, std::int32_t body) {
  return unknowns.translation(body) != Unknowns::none || unknowns.rotation(body) != Unknowns::none;
}

/// Adds blocks of several bodies to a matrix, and to what bounds it.
class Adder {
 public:
  Adder(const Unknowns& unknowns, BlockMatrix& matrix, std::vector<Mat6>& bound)
      : unknowns_(unknowns), matrix_(matrix), bound_(bound) {}

  void add(std::int32_t row_body, std::int32_t column_body, const Mat6& block, int moving) {
    const Mat6 own = unknowns_.has_axes() ? unknowns_.in_own_axes(row_body, column_body, block) : block;
    scatter_pair(
        row_body, column_body, own, unknowns_,
        [&](std::int32_t row, std::int32_t column, const Mat3& part) { add_to(matrix_, row, column, part); });
    if (row_body == column_body) bound_[static_cast<std::size_t>(row_body)] += moving * block;
  }
  void add(const SkinBlocks& blocks) {
    int moving = 0;
    for (int i = 0; i < SkinBlocks::bodies; ++i) moving += can_move(unknowns_, blocks.body(i)) ? 1 : 0;
    for (int i = 0; i < SkinBlocks::bodies; ++i)
      for (int j = 0; j < SkinBlocks::bodies; ++j)
        add(blocks.body(i), blocks.body(j), blocks.block(i, j), moving);
  }

 private:
  const Unknowns& unknowns_;
  BlockMatrix& matrix_;
  std::vector<Mat6>& bound_;
};

Mat6 of_displacements(const Mat3& block) {
  Mat6 result = Mat6::Zero();
  result.topLeftCorner<3, 3>() = block;
  return result;
}

}  // namespace

BlockMatrix with_pattern(std::vector<std::vector<std::int32_t>> rows, std::int32_t columns) {
  BlockMatrix matrix;
  matrix.block_rows = static_cast<std::int32_t>(rows.size());
  matrix.block_columns = columns;
  matrix.offsets.reserve(rows.size() + 1);
  for (std::vector<std::int32_t>& row : rows) {
    std::ranges::sort(row);
    row.erase(std::unique(row.begin(), row.end()), row.end());
    matrix.columns.insert(matrix.columns.end(), row.begin(), row.end());
    matrix.offsets.push_back(static_cast<std::int32_t>(matrix.columns.size()));
    row = {};
  }
  matrix.values.assign(9 * matrix.columns.size(), 0.0);
  return matrix;
}

void add_to(BlockMatrix& matrix, std::int32_t row, std::int32_t column, const Mat3& block) {
  const auto begin = matrix.columns.begin() + matrix.offsets[static_cast<std::size_t>(row)];
  const auto end = matrix.columns.begin() + matrix.offsets[static_cast<std::size_t>(row) + 1];
  const auto place = std::lower_bound(begin, end, column) - matrix.columns.begin();
  Eigen::Map<RowMajor3>(matrix.values.data() + 9 * static_cast<std::size_t>(place)) += block;
}

std::vector<TouchedBody> touched_by_nodal(const Model& model, Listed which) {
  std::vector<TouchedBody> touched;
  for (const auto& solid : model.solids)
    for (const std::int32_t row : solid->row) touched.push_back({row, false});
  for_each_skin_element(model, which, [&](const auto& /*law*/, const contact::SkinElement& skin) {
    const contact::ContactStiffness& k = skin.element.stiffness;
    touched.push_back({skin.element.a, k.shear > 0 || k.twist > 0 || k.bending > 0});
  });
  return touched;
}

NodalStiffness nodal_stiffness(const Model& model, Listed which, const Unknowns& unknowns) {
  NodalStiffness result;
  if (model.solids.empty()) return result;
  std::vector<std::vector<std::int32_t>> rows(static_cast<std::size_t>(unknowns.blocks()));
  const auto couple = [&](std::int32_t row_body, std::int32_t column_body) {
    for (const std::int32_t row : unknowns.of(row_body))
      for (const std::int32_t column : unknowns.of(column_body))
        if (row != Unknowns::none && column != Unknowns::none)
          rows[static_cast<std::size_t>(row)].push_back(column);
  };
  for (const auto& solid : model.solids) {
    const auto n = static_cast<std::size_t>(solid->elements.nodes());
    for (std::size_t first = 0; first < solid->rows.size(); first += n) {
      const auto nodes = std::span(solid->rows).subspan(first, n);
      for (const std::int32_t row : nodes)
        for (const std::int32_t column : nodes) couple(row, column);
    }
  }
  bool damps = false;
  for_each_skin_element(model, which, [&](const auto& law, const contact::SkinElement& skin) {
    const auto& corner = skin.point.body;
    const std::array<std::int32_t, 4> bodies{skin.element.a, corner[0], corner[1], corner[2]};
    for (const std::int32_t row : bodies)
      for (const std::int32_t column : bodies) couple(row, column);
    const contact::ContactDamping c = dashpots_of(law, skin.element, model.bodies.mass);
    damps = damps || c.normal > 0 || c.shear > 0;
  });
  result.k = with_pattern(std::move(rows), unknowns.blocks());
  const auto bodies = static_cast<std::size_t>(model.bodies.size());
  result.bound.assign(bodies, Mat6::Zero());
  Adder stiffness(unknowns, result.k, result.bound);
  for_each_node_block(model.solids, model.bodies.position,
                      [&](std::int32_t row, std::int32_t column, const Mat3& block, int nodes) {
                        stiffness.add(row, column, of_displacements(block), nodes);
                      });
  BlockMatrix viscous;
  if (damps) {
    viscous = result.k;
    std::ranges::fill(viscous.values, 0.0);
    result.viscous_bound.assign(bodies, Mat6::Zero());
  }
  Adder viscosity(unknowns, viscous, result.viscous_bound);
  for_each_skin_element(model, which, [&](const auto& law, const contact::SkinElement& skin) {
    stiffness.add({skin.element.a, skin.point, stiffness_of(skin.element)});
    if (!damps) return;
    const contact::ContactDamping c = dashpots_of(law, skin.element, model.bodies.mass);
    contact::ContactElement dashpots = skin.element;
    dashpots.stiffness = {.normal = c.normal, .shear = c.shear};
    viscosity.add({skin.element.a, skin.point, stiffness_of(dashpots)});
  });
  result.viscous = std::move(viscous.values);
  return result;
}

void for_each_nodal_tangent(const Model& model, const Trial& trial, const Unknowns& unknowns,
                            const std::function<void(std::int32_t, std::int32_t, const Mat3&)>& add) {
  for_each_node_block(model.solids, trial.position,
                      [&](std::int32_t row, std::int32_t column, const Mat3& block, int) {
                        scatter_pair(row, column, of_displacements(block), unknowns, add);
                      });
  if (model.solids.empty()) return;
  contact::Placement placement = placement_in(model, trial);
  model::Facets facets = model.facets;
  place_skins(model.solids, trial.position, facets);
  placement.facets = &facets;
  for_each_acting(model, placement, [&](const auto& group, std::size_t c, const auto& geometry) {
    using Kinematics = typename std::decay_t<decltype(group)>::KinematicsType;
    if constexpr (std::is_same_v<Kinematics, contact::BallFacet>) {
      const contact::Pair& pair = group.pairs[c];
      if (!contact::on_skin<Kinematics>(placement, pair)) return;
      const auto motion = motion_in<Kinematics>(group.law, placement, trial, pair, geometry);
      typename std::decay_t<decltype(group)>::State discarded;
      const Mat12 k = contact::consistent_tangent(geometry, Kinematics::curvature(placement, pair, geometry),
                                                  group.law.evaluate(motion, group.states[c], discarded),
                                                  group.law.tangent(motion, group.states[c]));
      const SkinBlocks blocks(model.bodies.clumps.owner(pair.a), contact::skin_point(placement, pair),
                              of_holder(model.bodies, pair.a, k));
      for (int i = 0; i < SkinBlocks::bodies; ++i)
        for (int j = 0; j < SkinBlocks::bodies; ++j) {
          const Mat6 block = blocks.block(i, j);
          scatter_pair(
              blocks.body(i), blocks.body(j),
              unknowns.has_axes() ? unknowns.in_own_axes(blocks.body(i), blocks.body(j), block) : block,
              unknowns, add);
        }
    }
  });
}

}  // namespace eigengrain::assembly
