#pragma once

#include "eigengrain/base/vec.hpp"
#include "eigengrain/contact/element.hpp"

#include <span>
#include <vector>

namespace eigengrain::assembly {

/// The 6×6 diagonal blocks of K, one a body, on (u, θ); fixed components are not struck out. A sink of
/// assemble_stiffness: what point-block preconditioners and estimates per body are made of. Memory 288 bytes
/// a body.
class BlockDiagonal {
 public:
  explicit BlockDiagonal(std::int32_t bodies) : blocks_(static_cast<std::size_t>(bodies), Mat6::Zero()) {}

  void add(const contact::ContactElement& element) {
    const contact::ContactBlocks k = contact::stiffness_blocks(element);
    block(element.a) += k.aa;
    if (element.b == contact::no_body) return;
    block(element.b) += k.bb;
    // A body that touches its own image couples with itself.
    if (element.a == element.b) block(element.a) += k.ab + k.ab.transpose();
  }

  /// [bodies]
  std::span<const Mat6> blocks() const { return blocks_; }

 private:
  Mat6& block(std::int32_t body) { return blocks_[static_cast<std::size_t>(body)]; }

  std::vector<Mat6> blocks_;
};

}  // namespace eigengrain::assembly
