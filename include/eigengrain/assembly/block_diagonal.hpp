#pragma once

#include "eigengrain/base/vec.hpp"
#include "eigengrain/contact/element.hpp"

#include <span>
#include <vector>

namespace eigengrain::assembly {

/// The 6×6 diagonal blocks of K, one a body, on (u, θ) along the axes of space; fixed components are not
/// struck out, and a clump's block is in the row of its holder. A sink of
/// assemble_stiffness: what point-block preconditioners and estimates per body are made of. Memory 288 bytes
/// a body.
class BlockDiagonal {
 public:
  explicit BlockDiagonal(std::int32_t bodies) : blocks_(static_cast<std::size_t>(bodies), Mat6::Zero()) {}

  void add(const contact::ContactElement& element) {
    if (element.a == element.b) {
      block(element.a) += contact::self_block(element);
      return;
    }
    block(element.a) += contact::end_block(element, element.lever_a);
    if (element.b != contact::no_body) block(element.b) += contact::end_block(element, element.lever_b);
  }

  /// [bodies]
  std::span<const Mat6> blocks() const { return blocks_; }

 private:
  Mat6& block(std::int32_t body) { return blocks_[body]; }

  std::vector<Mat6> blocks_;
};

}  // namespace eigengrain::assembly
