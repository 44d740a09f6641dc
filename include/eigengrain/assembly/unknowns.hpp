#pragma once

#include "eigengrain/contact/element.hpp"
#include "eigengrain/model/bodies.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace eigengrain::assembly {

/// A body that something else than contacts of two bodies resists.
struct TouchedBody {
  std::int32_t body = 0;
  bool turned = false;  ///< its rotation too
};

/// Which unknowns a scene has. Every unknown is a vector, a block of three numbers.
///
/// A body may have two, u and θ. A clump has them in the row of its holder, and its θ along its principal
/// axes, in which its inertia is diagonal. Not numbered are
///   - bodies that no acting contact touches: they are set aside and reported;
///   - θ of a body whose contacts have no shear or rotational stiffness, but for clumps, which any force can
///     turn;
///   - vectors whose three components are fixed.
/// A vector with one or two fixed components is numbered, and those components are masked: their rows and
/// columns are zero in every matrix and are kept out of spectra (see free_components).
class Unknowns {
 public:
  static constexpr int block_size = 3;
  static constexpr std::int32_t none = -1;

  Unknowns(const model::Bodies& bodies, std::span<const contact::ContactElement> elements,
           std::span<const TouchedBody> others = {});

  /// Rows of the model's bodies, with unknowns or without.
  std::int32_t bodies() const { return static_cast<std::int32_t>(block_.size()); }
  /// Vector unknowns.
  std::int32_t blocks() const { return static_cast<std::int32_t>(body_.size()); }
  /// Numbers: three a block, masked ones included.
  std::int64_t size() const { return block_size * static_cast<std::int64_t>(body_.size()); }

  /// Block of the body's u or θ, or none.
  std::int32_t translation(std::int32_t body) const { return block_[body][0]; }
  std::int32_t rotation(std::int32_t body) const { return block_[body][1]; }
  /// {u, θ} of a body; {none, none} for contact::no_body.
  std::array<std::int32_t, 2> of(std::int32_t body) const {
    return body == contact::no_body ? std::array{none, none} : block_[body];
  }

  /// The way back: the body of a block, and whether the block is its θ.
  std::int32_t body(std::int32_t block) const { return body_[block]; }
  bool is_rotation(std::int32_t block) const { return is_rotation_[block] != 0; }
  /// Whether component k = 0, 1, 2 of the block is fixed (masked).
  bool is_fixed(std::int32_t block, int k) const { return ((mask_[block] >> k) & 1) != 0; }

  /// Numbers that are free to move, in increasing order: what spectra are made of.
  std::vector<std::int32_t> free_components() const;

  /// The axes of the θ of a body, as columns in space; null where these are the axes of space.
  const Mat3* axes(std::int32_t body) const {
    if (axes_of_.empty() || body == contact::no_body || axes_of_[body] == none) return nullptr;
    return &axes_[axes_of_[body]];
  }
  /// Whether any body has axes of its own.
  bool has_axes() const { return !axes_.empty(); }
  /// A 6×6 on (u, θ) of two bodies, with θ along the axes of space, brought to the axes of the unknowns.
  Mat6 in_own_axes(std::int32_t row_body, std::int32_t column_body, const Mat6& block) const;

  /// Blocks that are a θ.
  std::int32_t rotations() const { return rotations_; }
  /// Bodies that are not fixed entirely, but that no acting contact touches.
  const std::vector<std::int32_t>& set_aside() const { return set_aside_; }

 private:
  std::vector<std::array<std::int32_t, 2>> block_;
  std::vector<std::int32_t> body_;
  std::vector<std::uint8_t> is_rotation_;
  std::vector<std::uint8_t> mask_;  ///< bits 0-2: fixed components
  std::vector<std::int32_t> set_aside_;
  std::vector<std::int32_t> axes_of_;  ///< [bodies] index into axes_, or none; empty without clumps
  std::vector<Mat3> axes_;             ///< [clumps]
  std::int32_t rotations_ = 0;
};

}  // namespace eigengrain::assembly
