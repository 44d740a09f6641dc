#include "eigengrain/generate/sizes.hpp"

#include "eigengrain/base/error.hpp"
#include "eigengrain/base/text.hpp"
#include "eigengrain/generate/balls.hpp"
#include "eigengrain/model/bodies.hpp"

#include "elementary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <utility>

namespace eigengrain::generate {
namespace {

/// Mean and deviation of log r.
struct LogMoments {
  explicit LogMoments(const LognormalSizes& sizes) {
    const double ratio = sizes.deviation / sizes.mean;
    const double variance = elementary::log(1 + ratio * ratio);
    deviation = std::sqrt(variance);
    mean = elementary::log(sizes.mean) - variance / 2;
  }
  double mean = 0;
  double deviation = 0;
};

double below(double z) {
  return 0.5 * std::erfc(-z / std::numbers::sqrt2);
}

void require_share(double share, double least, double most) {
  if (share >= 0.01) return;
  throw InputError(
      fmt::format("only a part of {:.2g} of the distribution lies between {:.6g} and {:.6g} m; widen them, "
                  "or move its mean between them",
                  share, least, most));
}

void check(const NormalSizes& s) {
  require_share(below((s.most - s.mean) / s.deviation) - below((s.least - s.mean) / s.deviation), s.least,
                s.most);
}
void check(const LognormalSizes& s) {
  const LogMoments log(s);
  const double up_to_least = s.least > 0 ? below((std::log(s.least) - log.mean) / log.deviation) : 0;
  require_share(below((std::log(s.most) - log.mean) / log.deviation) - up_to_least, s.least, s.most);
}
template <class Other>
void check(const Other&) {}

double draw_from(const ConstantSize& s, Random&) {
  return s.radius;
}

double draw_from(const UniformSizes& s, Random& random) {
  return s.least + random.uniform() * (s.most - s.least);
}

double draw_from(const NormalSizes& s, Random& random) {
  while (true) {
    const double r = s.mean + s.deviation * random.normal();
    if (r > 0 && r >= s.least && r <= s.most) return r;
  }
}

double draw_from(const LognormalSizes& s, Random& random) {
  const LogMoments log(s);
  while (true) {
    const double r = elementary::exp(log.mean + log.deviation * random.normal());
    if (r >= s.least && r <= s.most) return r;
  }
}

/// The inverse of the cumulated numbers. Near exponent -1 those are a logarithm.
double draw_from(const PowerLawSizes& s, Random& random) {
  const double u = random.uniform();
  const double ratio = s.most / s.least;
  const double p = s.exponent + 1;
  if (std::abs(p) < 1e-6) return s.least * elementary::pow(ratio, u);
  const double r = s.least * elementary::pow(1 + u * (elementary::pow(ratio, p) - 1), 1 / p);
  return std::min(std::max(r, s.least), s.most);  // rounding may step over the ends
}

/// How many balls a class has for its share. By mass, numbers go with r^-3, whose mean over the class is
/// (least + most)/(2 least² most²).
double number_of(const SizeClass& c, bool by_mass) {
  return by_mass ? c.share * (c.least + c.most) / (2 * c.least * c.least * c.most * c.most) : c.share;
}

double draw_from(const TableSizes& s, Random& random) {
  double all = 0;
  for (const SizeClass& c : s.classes) all += number_of(c, s.by_mass);
  double rest = random.uniform() * all;
  const SizeClass* chosen = &s.classes.back();
  for (const SizeClass& c : s.classes) {
    rest -= number_of(c, s.by_mass);
    if (rest >= 0) continue;
    chosen = &c;
    break;
  }
  const double u = random.uniform();
  const double least = chosen->least;
  const double most = chosen->most;
  if (least == most) return least;
  if (!s.by_mass) return least + u * (most - least);
  // Numbers go with r^-3, so those up to r with 1/least² - 1/r².
  const double from = 1 / (least * least);
  const double to = 1 / (most * most);
  return 1 / std::sqrt(from + u * (to - from));
}

}  // namespace

SizeSampler::SizeSampler(SizeDistribution distribution) : distribution_(std::move(distribution)) {
  std::visit([](const auto& sizes) { check(sizes); }, distribution_);
}

double SizeSampler::draw(Random& random) const {
  return std::visit([&](const auto& sizes) { return draw_from(sizes, random); }, distribution_);
}

std::vector<double> draw_radii(const SizeSampler& sampler, double volume, Random& random) {
  std::vector<double> radii;
  double rest = volume;
  while (true) {
    const double radius = sampler.draw(random);
    const double sphere = model::sphere_mass(radius, 1.0);
    if (rest < sphere / 2) break;
    if (std::ssize(radii) == most_balls)
      throw InputError(fmt::format("more than {} balls; are the units right?", grouped(most_balls)));
    radii.push_back(radius);
    rest -= sphere;
  }
  if (radii.empty())
    throw InputError(
        fmt::format("the balls asked for have a volume of {:.3g} m3, less than half of one ball", volume));
  return radii;
}

}  // namespace eigengrain::generate
