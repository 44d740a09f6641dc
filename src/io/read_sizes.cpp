#include "read_sizes.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstddef>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

namespace eigengrain::io {
namespace {

using generate::SizeDistribution;

/// The keys of a distribution.
struct Shape {
  std::string_view name;
  std::vector<std::string_view> needs;
  std::vector<std::string_view> may_have;
};

const std::vector<Shape>& shapes() {
  static const std::vector<Shape> all{
      {"uniform", {"min", "max"}, {}},
      {"normal", {"mean", "deviation"}, {"min", "max"}},
      {"lognormal", {"mean", "deviation"}, {"min", "max"}},
      {"power", {"exponent", "min", "max"}, {}},
      {"table", {"radii"}, {"shares", "passing", "by"}},
  };
  return all;
}

bool among(std::string_view key, const std::vector<std::string_view>& keys) {
  return std::find(keys.begin(), keys.end(), key) != keys.end();
}

/// Reports keys that the distribution needs and those that it does not know; whether none was.
bool check_shape(const Section& section, const Shape& shape) {
  bool good = true;
  for (const std::string_view key : shape.needs) {
    if (section.has(key)) continue;
    section.report_missing(key, fmt::format(", which distribution {} needs", shape.name));
    good = false;
  }
  for (const std::string_view key :
       {"min", "max", "mean", "deviation", "exponent", "radii", "shares", "passing", "by"}) {
    if (!section.has(key) || among(key, shape.needs) || among(key, shape.may_have)) continue;
    section.report(key, fmt::format("has no meaning with distribution {}, which takes {}{}{}; remove it",
                                    shape.name, fmt::join(shape.needs, ", "),
                                    shape.may_have.empty() ? "" : ", ", fmt::join(shape.may_have, ", ")));
    good = false;
  }
  return good;
}

/// min and max, or what stands for them.
struct Limits {
  double least = 0;
  double most = 0;
};

std::optional<Limits> read_limits(const Section& section, const Limits& otherwise) {
  const auto read = [&](std::string_view key, double fallback) {
    return section.has(key) ? section.quantity(key) : std::optional(fallback);
  };
  const auto least = read("min", otherwise.least);
  const auto most = read("max", otherwise.most);
  if (!least || !most) return std::nullopt;
  if (*least < *most) return Limits{*least, *most};
  section.report("max", fmt::format("{} m is not above min, {} m", *most, *least));
  return std::nullopt;
}

std::optional<SizeDistribution> read_normal(const Section& section, double mean, double deviation) {
  const double least = mean - 3 * deviation;
  if (least <= 0 && !section.has("min")) {
    section.report_missing("min", ", and mean - 3 deviations is not positive");
    return std::nullopt;
  }
  const auto limits = read_limits(section, {least, mean + 3 * deviation});
  if (!limits) return std::nullopt;
  return generate::NormalSizes{
      .mean = mean, .deviation = deviation, .least = limits->least, .most = limits->most};
}

std::optional<SizeDistribution> read_bell(const Section& section, bool lognormal) {
  const auto mean = section.quantity("mean");
  const auto deviation = section.quantity("deviation");
  if (!mean || !deviation) return std::nullopt;
  if (!lognormal) return read_normal(section, *mean, *deviation);
  const auto limits = read_limits(section, {0, std::numeric_limits<double>::infinity()});
  if (!limits) return std::nullopt;
  return generate::LognormalSizes{
      .mean = *mean, .deviation = *deviation, .least = limits->least, .most = limits->most};
}

/// Parts of a table: one radius each.
std::vector<generate::SizeClass> classes_of_shares(const std::vector<double>& radii,
                                                   const std::vector<double>& shares) {
  std::vector<generate::SizeClass> classes;
  for (std::size_t k = 0; k < radii.size(); ++k)
    if (shares[k] > 0) classes.push_back({radii[k], radii[k], shares[k]});
  return classes;
}

/// Parts of a table: radii between two neighbours, which may be equal.
std::vector<generate::SizeClass> classes_of_passing(const std::vector<double>& radii,
                                                    const std::vector<double>& passing) {
  std::vector<generate::SizeClass> classes;
  for (std::size_t k = 1; k < radii.size(); ++k)
    if (passing[k] > passing[k - 1]) classes.push_back({radii[k - 1], radii[k], passing[k] - passing[k - 1]});
  return classes;
}

/// Whether `passing` climbs from 0 to 1 while radii do not fall.
bool check_passing(const Section& section, const std::vector<double>& radii,
                   const std::vector<double>& passing) {
  if (!std::is_sorted(radii.begin(), radii.end()))
    section.report("radii", "not in increasing order, which passing wants");
  else if (!std::is_sorted(passing.begin(), passing.end()) || passing.front() != 0 || passing.back() != 1)
    section.report(
        "passing",
        "does not increase from 0 at the first radius to 1 at the last, e.g. \"passing: [0, 0.4, 1]\"");
  else
    return true;
  return false;
}

std::optional<SizeDistribution> read_table(const Section& section) {
  if (section.has("shares") == section.has("passing")) {
    section.report("wants shares or passing beside radii, e.g. \"shares: [0.3, 0.7]\"");
    return std::nullopt;
  }
  const std::string_view key = section.has("shares") ? "shares" : "passing";
  const auto radii = section.quantities("radii");
  const auto parts = section.quantities(key);
  const auto by = section.text("by");
  if (!radii || !parts || !by) return std::nullopt;
  if (radii->empty() || radii->size() != parts->size()) {
    section.report(key, fmt::format("{} values, and radii has {}; as many are wanted, at least one",
                                    parts->size(), radii->size()));
    return std::nullopt;
  }
  if (key == "passing" && !check_passing(section, *radii, *parts)) return std::nullopt;
  generate::TableSizes table{
      .classes = key == "shares" ? classes_of_shares(*radii, *parts) : classes_of_passing(*radii, *parts),
      .by_mass = *by == "mass"};
  if (!table.classes.empty()) return table;
  section.report(key, "nothing but zeros, which leaves no balls");
  return std::nullopt;
}

std::optional<SizeDistribution> read_distribution(const Section& section) {
  section.check_keys();
  const auto name = section.text("distribution");
  if (!name) return std::nullopt;
  const auto shape =
      std::find_if(shapes().begin(), shapes().end(), [&](const Shape& s) { return s.name == *name; });
  if (!check_shape(section, *shape)) return std::nullopt;
  if (*name == "table") return read_table(section);
  if (*name == "normal" || *name == "lognormal") return read_bell(section, *name == "lognormal");
  const auto limits = read_limits(section, {});
  if (!limits) return std::nullopt;
  if (*name == "uniform") return generate::UniformSizes{.least = limits->least, .most = limits->most};
  const auto exponent = section.quantity("exponent");
  if (!exponent) return std::nullopt;
  return generate::PowerLawSizes{.exponent = *exponent, .least = limits->least, .most = limits->most};
}

}  // namespace

std::optional<SizeDistribution> read_sizes(const Section& entry) {
  if (entry.has("radius") && entry.has("sizes")) {
    entry.report("sizes", "beside radius, which gives all balls one size; remove one of the two");
    return std::nullopt;
  }
  if (!entry.has("sizes")) {
    if (!entry.has("radius")) entry.report_missing("radius", ", or sizes");
    const auto radius = entry.quantity("radius");
    if (!radius) return std::nullopt;
    return generate::ConstantSize{*radius};
  }
  const auto section = entry.section("sizes");
  return section ? read_distribution(*section) : std::nullopt;
}

}  // namespace eigengrain::io
