#include "eigengrain/assembly/unknowns.hpp"

namespace eigengrain::assembly {
namespace {

/// What the contacts of a body ask of it.
struct Demand {
  bool touched = false;
  bool turned = false;  ///< some contact resists its rotation
};

std::vector<Demand> demands(std::int32_t bodies, std::span<const contact::ContactElement> elements) {
  std::vector<Demand> result(static_cast<std::size_t>(bodies));
  for (const contact::ContactElement& element : elements) {
    const contact::ContactStiffness& k = element.stiffness;
    const bool turns = k.shear > 0 || k.twist > 0 || k.bending > 0;
    for (const std::int32_t body : {element.a, element.b}) {
      if (body == contact::no_body) continue;
      Demand& demand = result[body];
      demand.touched = true;
      demand.turned = demand.turned || turns;
    }
  }
  return result;
}

}  // namespace

Unknowns::Unknowns(const model::Bodies& bodies, std::span<const contact::ContactElement> elements,
                   std::span<const TouchedBody> others)
    : block_(bodies.position.size(), {none, none}) {
  const model::Clumps& clumps = bodies.clumps;
  if (!clumps.empty()) axes_of_.assign(bodies.position.size(), none);
  for (std::int32_t c = 0; c < clumps.size(); ++c) {
    axes_of_[clumps.holder(c)] = c;
    axes_.emplace_back(clumps.orientation[c].toRotationMatrix());
  }
  std::vector<Demand> demand = demands(bodies.size(), elements);
  for (const TouchedBody& other : others) {
    demand[other.body].touched = true;
    demand[other.body].turned = demand[other.body].turned || other.turned;
  }
  const auto number = [&](std::int32_t body, int which, std::uint8_t fixed) {
    if (fixed == 7) return;
    block_[body][which] = blocks();
    body_.push_back(body);
    is_rotation_.push_back(static_cast<std::uint8_t>(which));
    mask_.push_back(fixed);
    rotations_ += which;
  };
  for (std::int32_t body = 0; body < bodies.size(); ++body) {
    const model::FixedComponents fixed = bodies.fixed[body];
    const Demand& wanted = demand[body];
    if (clumps.owner(body) != body) continue;
    if (!wanted.touched) {
      if (!fixed.all()) set_aside_.push_back(body);
      continue;
    }
    number(body, 0, fixed.translation());
    if (wanted.turned || axes(body) != nullptr) number(body, 1, fixed.rotation());
  }
}

Mat6 Unknowns::in_own_axes(std::int32_t row_body, std::int32_t column_body, const Mat6& block) const {
  Mat6 result = block;
  if (const Mat3* q = axes(row_body)) result.bottomRows<3>() = q->transpose() * block.bottomRows<3>();
  if (const Mat3* q = axes(column_body)) result.rightCols<3>() = (result.rightCols<3>() * *q).eval();
  return result;
}

std::vector<std::int32_t> Unknowns::free_components() const {
  std::vector<std::int32_t> result;
  result.reserve(static_cast<std::size_t>(size()));
  for (std::int32_t block = 0; block < blocks(); ++block)
    for (int k = 0; k < block_size; ++k)
      if (!is_fixed(block, k)) result.push_back(block_size * block + k);
  return result;
}

}  // namespace eigengrain::assembly
