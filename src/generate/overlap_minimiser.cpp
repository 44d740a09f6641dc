#include "overlap_minimiser.hpp"

#include "eigengrain/base/parallel.hpp"
#include "eigengrain/search/candidates.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <utility>

namespace eigengrain::generate {
namespace {

/// Loops are short and many: fewer balls than this are not worth a second thread.
constexpr std::int64_t chunk_size = 4096;

/// FIRE's numbers (those of Guénolé et al., Comput. Mater. Sci. 175, 109584, 2020) but for the longest step:
/// a contact network of unit masses and stiffnesses has eigenvalues up to twice its number of contacts a
/// ball, 24, which makes 2/√24 = 0.41 the stable step.
constexpr double first_step = 0.1;
constexpr double longest_step = 0.4;
constexpr double shortest_step = 1e-4;
constexpr double first_mixing = 0.25;
constexpr int patience = 5;

/// Runs body(begin, end) over fixed chunks and sums what it returns in their order.
template <class Sum, class Body>
Sum sum_chunks(std::int64_t n, const Body& body) {
  std::vector<Sum> parts(static_cast<std::size_t>((n + chunk_size - 1) / chunk_size));
  for_chunks(n, chunk_size, [&](std::int64_t begin, std::int64_t end, std::int64_t chunk) {
    parts[static_cast<std::size_t>(chunk)] = body(begin, end);
  });
  Sum all{};
  for (const Sum& part : parts) all.add(part);
  return all;
}

struct Total {
  double value = 0;
  void add(const Total& other) { value += other.value; }
};
struct Maximum {
  double value = 0;
  void add(const Maximum& other) { value = std::max(value, other.value); }
};

}  // namespace

void Overlaps::add(const Overlaps& other) {
  contacts += other.contacts;
  ends += other.ends;
  sum += other.sum;
  relative_sum += other.relative_sum;
  largest = std::max(largest, other.largest);
  force += other.force;
  scaled_force += other.scaled_force;
  power += other.power;
}

OverlapMinimiser::OverlapMinimiser(std::vector<Vec3> centres, std::vector<double> radii, const Region& region)
    : region_(region),
      cell_(region.cell()),
      centres_(std::move(centres)),
      given_radii_(std::move(radii)),
      radii_(given_radii_),
      velocity_(centres_.size(), Vec3::Zero()),
      force_(centres_.size(), Vec3::Zero()) {
  const double mean = std::accumulate(radii_.begin(), radii_.end(), 0.0) / static_cast<double>(radii_.size());
  skin_ = 0.4 * mean;
  inverse_mass_.reserve(radii_.size());
  // A ball among balls of the mean radius has as many contacts as those have room on a sphere around it.
  for (const double r : radii_) inverse_mass_.push_back(4 * mean * mean / ((r + mean) * (r + mean)));
}

void OverlapMinimiser::set_scale(double factor) {
  std::transform(given_radii_.begin(), given_radii_.end(), radii_.begin(),
                 [=](double r) { return factor * r; });
  offsets_.clear();
}

Overlaps OverlapMinimiser::measure() {
  return evaluate();
}

OverlapMinimiser::End OverlapMinimiser::minimise(double apart, double balance, std::int64_t most_iterations) {
  std::fill(velocity_.begin(), velocity_.end(), Vec3::Zero());
  double dt = first_step;
  double mixing = first_mixing;
  int downhill = 0;
  Overlaps now = evaluate();
  for (std::int64_t k = 0; k < most_iterations; ++k, ++iterations_) {
    if (now.largest <= apart) return End::apart;
    const double mean_force = now.sum / now.contacts;
    if (now.force <= balance * balance * mean_force * mean_force * static_cast<double>(centres_.size()))
      return End::balanced;
    if (now.power > 0 || k == 0) {
      if (++downhill > patience) {
        dt = std::min(1.1 * dt, longest_step);
        mixing *= 0.99;
      }
    } else {
      stop_and_go_back(dt);
      downhill = 0;
      dt = std::max(dt / 2, shortest_step);
      mixing = first_mixing;
    }
    move(dt, mixing, now.scaled_force);
    now = evaluate();
  }
  return now.largest <= apart ? End::apart : End::tired;
}

/// The last step went uphill: half of it is taken back.
void OverlapMinimiser::stop_and_go_back(double dt) {
  for_each_index(std::ssize(centres_), [&](std::int64_t i) {
    centres_[i] -= (0.5 * dt) * velocity_[i];
    velocity_[i] = Vec3::Zero();
  });
}

/// A step of semi-implicit Euler, with the velocity turned towards the force (lengths in the metric of the
/// masses).
void OverlapMinimiser::move(double dt, double mixing, double scaled_force) {
  const std::int64_t n = std::ssize(centres_);
  const Total energy = sum_chunks<Total>(n, [&](std::int64_t begin, std::int64_t end) {
    Total sum;
    for (std::int64_t i = begin; i < end; ++i) {
      velocity_[i] += (dt * inverse_mass_[i]) * force_[i];
      sum.value += velocity_[i].squaredNorm() / inverse_mass_[i];
    }
    return sum;
  });
  const double along_force = scaled_force > 0 ? mixing * std::sqrt(energy.value / scaled_force) : 0;
  const Maximum moved = sum_chunks<Maximum>(n, [&](std::int64_t begin, std::int64_t end) {
    Maximum farthest;
    for (std::int64_t i = begin; i < end; ++i) {
      velocity_[i] = (1 - mixing) * velocity_[i] + (along_force * inverse_mass_[i]) * force_[i];
      centres_[i] += dt * velocity_[i];
      farthest.value = std::max(farthest.value, (centres_[i] - listed_at_[i]).squaredNorm());
    }
    return farthest;
  });
  moved_ = std::sqrt(moved.value);
}

Overlaps OverlapMinimiser::evaluate() {
  if (offsets_.empty() || 2 * moved_ > skin_) list_neighbours();
  return sum_chunks<Overlaps>(std::ssize(centres_),
                              [&](std::int64_t begin, std::int64_t end) { return forces_on(begin, end); });
}

Overlaps OverlapMinimiser::forces_on(std::int64_t begin, std::int64_t end) {
  Overlaps sums;
  for (std::int64_t i = begin; i < end; ++i) {
    Vec3 force = Vec3::Zero();
    for (std::int64_t k = offsets_[i]; k < offsets_[i + 1]; ++k) {
      const Neighbour& near = neighbours_[k];
      const Vec3 d = centres_[near.ball] + cell_.shift(near.image) - centres_[i];
      const double reach = radii_[i] + radii_[near.ball];
      const double squared = d.squaredNorm();
      if (squared >= reach * reach || squared == 0) continue;
      const double distance = std::sqrt(squared);
      const double overlap = reach - distance;
      force -= (overlap / distance) * d;
      sums.contacts += 0.5;
      sums.ends += 1;
      sums.sum += 0.5 * overlap;
      sums.relative_sum += 0.5 * overlap / reach;
      sums.largest = std::max(sums.largest, overlap / reach);
    }
    add_faces(i, force, sums);
    force_[i] = force;
    sums.force += force.squaredNorm();
    sums.scaled_force += force.squaredNorm() * inverse_mass_[i];
    sums.power += force.dot(velocity_[i]);
  }
  return sums;
}

void OverlapMinimiser::add_faces(std::int64_t ball, Vec3& force, Overlaps& sums) const {
  const double r = radii_[ball];
  for (int k = 0; k < 3; ++k) {
    if (region_.periodic[k]) continue;
    const double x = centres_[ball][k];
    for (const double side : {1.0, -1.0}) {
      const double height = side > 0 ? x - region_.lower[k] : region_.upper[k] - x;
      const double overlap = r - height;
      if (overlap <= 0) continue;
      force[k] += side * overlap;
      sums.contacts += 1;
      sums.ends += 1;
      sums.sum += overlap;
      sums.relative_sum += overlap / r;
      sums.largest = std::max(sums.largest, overlap / r);
    }
  }
}

void OverlapMinimiser::list_neighbours() {
  const std::vector<search::CandidatePair> pairs = search::candidate_pairs(centres_, radii_, cell_, skin_);
  const std::size_t n = centres_.size();
  offsets_.assign(n + 1, 0);
  for (const search::CandidatePair& pair : pairs) {
    ++offsets_[pair.a + 1];
    ++offsets_[pair.b + 1];
  }
  std::partial_sum(offsets_.begin(), offsets_.end(), offsets_.begin());
  neighbours_.resize(static_cast<std::size_t>(offsets_.back()));
  std::vector<std::int64_t> next(offsets_.begin(), offsets_.end() - 1);
  for (const search::CandidatePair& pair : pairs) {
    model::Image back{};
    for (std::size_t k = 0; k < 3; ++k) back[k] = static_cast<std::int8_t>(-pair.image[k]);
    neighbours_[next[pair.a]++] = {pair.b, pair.image};
    neighbours_[next[pair.b]++] = {pair.a, back};
  }
  listed_at_ = centres_;
  moved_ = 0;
}

}  // namespace eigengrain::generate
