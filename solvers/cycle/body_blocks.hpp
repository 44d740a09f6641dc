#pragma once

#include "eigengrain/assembly/linear_system.hpp"
#include "eigengrain/base/adjacency.hpp"
#include "eigengrain/base/parallel.hpp"
#include "eigengrain/base/vec.hpp"
#include "eigengrain/cycle/step_of.hpp"

#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

namespace eigengrain::cycle {

/// The 6×6 blocks of single bodies, scaled by masses from both sides, of which block bounds are made:
///
///   M_i^-½ [Σ_c f_c (K + μC)_c,ii] M_i^-½,    f_c = 1 + d_j/d_i
///
/// over the contacts c of body i with bodies j that can move, f_c = 1 where the other side cannot, and the
/// whole block of a contact of the body with its own image.
class BodyBlocks {
 public:
  /// Refers to the system, which must outlive it; its stiffnesses and geometry may change in between, its
  /// bodies and which of them the elements are between may not.
  ///
  /// mass_divisor  [bodies] M_i is divided by it (1 + α_i of local damping); empty: by one
  explicit BodyBlocks(const assembly::LinearSystem& system, std::span<const double> mass_divisor = {});
  /// M_i is divided by this from now on.
  void divide_mass(std::int32_t body, double divisor) { divisor_[static_cast<std::size_t>(body)] = divisor; }

  std::int32_t bodies() const { return static_cast<std::int32_t>(scale_.size()); }
  /// Ends of contacts at a body: 2c is the first end of contact c, 2c + 1 the second.
  std::span<const std::int32_t> ends(std::int32_t body) const { return ends_.links(body); }
  /// The body at the other side of an end, or contact::no_body where nothing can move there.
  std::int32_t other(std::int32_t end) const {
    const contact::ContactElement& element = system_.elements[static_cast<std::size_t>(end / 2)];
    const std::int32_t body = end % 2 == 0 ? element.b : element.a;
    return body == contact::no_body || element.a == element.b || !moves_[static_cast<std::size_t>(body)]
               ? contact::no_body
               : body;
  }

  /// The block of a body, 1/s². weight: [bodies] d > 0; mu in 1/s.
  Mat6 block(std::int32_t body, std::span<const double> weight, double mu = 0) const;
  /// The block as own + others/d_i: what does not depend on d_i, and what goes with its inverse.
  struct Parts {
    Mat6 own;
    Mat6 others;
  };
  Parts parts(std::int32_t body, std::span<const double> weight, double mu = 0) const;
  /// x·(K + μC)_c,ii x of one end, x in the scaled unknowns of the block, 1/s².
  double energy(std::int32_t body, std::int32_t end, const Vec6& x, double mu = 0) const;
  /// Bound of the relative error of a block's eigenvalues: a block is a sum of positive semidefinite ones,
  /// one for each end, each of which takes some ten operations.
  double rounding(std::int32_t body) const;
  /// The largest eigenvalue of block(), rounded up, 1/s²; not a number where the block is none.
  double eigenvalue(std::int32_t body, std::span<const double> weight, double mu = 0) const;
  /// No eigenvalue of block() is larger, rounding included. Several times cheaper than the block where levers
  /// are along normals.
  double bound(std::int32_t body, std::span<const double> weight, double mu = 0) const;
  /// The largest eigenvalue() of all bodies; not a number if one is not. Few bodies need theirs.
  ///
  /// ceiling  gives for a body what bound() does
  template <class Ceiling>
  double largest(std::span<const double> weight, double mu, const Ceiling& ceiling) const {
    std::vector<double> of_chunk(static_cast<std::size_t>((bodies() + chunk_size - 1) / chunk_size), 0.0);
    for_chunks(bodies(), chunk_size, [&](std::int64_t begin, std::int64_t end, std::int64_t chunk) {
      for (auto body = static_cast<std::int32_t>(begin); body < end; ++body)
        if (!(ceiling(body) <= of_chunk[chunk]))
          of_chunk[chunk] = larger(of_chunk[chunk], eigenvalue(body, weight, mu));
    });
    return std::accumulate(of_chunk.begin(), of_chunk.end(), 0.0, larger);
  }

  /// Of loops over bodies that look at their blocks.
  static constexpr std::int64_t chunk_size = 1024;

 private:
  contact::ContactStiffness stiffness(std::int32_t contact, double mu) const;
  /// Of sums over levers along normals, or of any 6×6.
  template <class Sum>
  Sum sum(std::int32_t body, std::span<const double> weight, double mu) const;
  Mat6 scaled(std::int32_t body, const Mat6& block) const;
  /// What elements of several bodies add, whatever the weights: each is at most the sum of its diagonal
  /// blocks times the number of its bodies.
  Mat6 nodal(std::int32_t body, double mu) const;

  const assembly::LinearSystem& system_;
  Adjacency ends_;
  std::vector<Vec6> scale_;      ///< [bodies] diagonal of M_i^-½, zero where there is no free component
  std::vector<double> divisor_;  ///< [bodies] of M_i
  std::vector<char> moves_;      ///< [bodies] whether any component is free
  std::vector<char> simple_;     ///< [bodies] free, round, and all levers along normals
};

}  // namespace eigengrain::cycle
