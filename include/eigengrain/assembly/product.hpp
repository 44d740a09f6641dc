#pragma once

#include "eigengrain/assembly/stiffness_parts.hpp"
#include "eigengrain/assembly/unknowns.hpp"
#include "eigengrain/contact/element.hpp"

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace eigengrain::assembly {

/// y = S K S x without K but for the part of deformable bodies: each contact is one compact record, from 32
/// bytes (no shear) through 64 (balls) to 128 (anything else), against about 700 bytes of an assembled
/// matrix.
///
/// S is a diagonal scaling: M^-½ for the eigenvalues of M⁻¹K (LinearSystem::inverse_sqrt_mass), or ones at
/// free components and zeros at masked ones for K itself.
///
/// Threads share fixed chunks of bodies. A contact inside a chunk is evaluated once for both its ends, a
/// contact between two chunks once in each, so nobody writes into another's rows and every row is summed in
/// one order: the result is the same to the bit on any number of threads.
class StiffnessProduct {
 public:
  /// parts  of bodies of `unknowns`; contacts are copied, what is of nodes is referred to and has to stay
  /// scale     [unknowns.size()] the diagonal of S; empty: one at free components
  StiffnessProduct(const Unknowns& unknowns, const StiffnessParts& parts, std::span<const double> scale = {});
  ~StiffnessProduct();
  StiffnessProduct(StiffnessProduct&&) noexcept;
  StiffnessProduct& operator=(StiffnessProduct&&) noexcept;

  /// x, y [size()]. Not to be called from two threads at once: it uses its own scratch vectors.
  void apply(std::span<const double> x, std::span<double> y);

  std::int64_t size() const;
  /// Bytes of contact records that one product streams.
  std::int64_t record_bytes() const;
  /// Calls of apply since construction.
  std::int64_t products() const;

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

}  // namespace eigengrain::assembly
