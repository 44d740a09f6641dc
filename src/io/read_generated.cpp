#include "read_generated.hpp"

#include "eigengrain/base/error.hpp"
#include "eigengrain/base/text.hpp"
#include "eigengrain/generate/dense_packing.hpp"
#include "eigengrain/generate/lattice.hpp"
#include "eigengrain/generate/random_fill.hpp"

#include "read_sizes.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace eigengrain::io {
namespace {

using generate::Balls;
using generate::Region;

constexpr std::string_view axis_names = "xyz";

void add(const Balls& made, const Section& section, const BallKind& kind, BallList& balls) {
  const Place place = section.place();
  balls.begin_file(place.file);
  for (std::size_t k = 0; k < made.radius.size(); ++k)
    balls.add(made.position[k], made.radius[k], kind, place.line);
}

/// Whether a box spans the cell along an axis, so that it repeats there.
bool spans(const Region& region, const model::PeriodicCell& cell, int axis) {
  const double length = cell.edges(axis, axis);
  const double tolerance = generate::negligible * length;
  return std::abs(region.lower[axis] - cell.origin[axis]) <= tolerance &&
         std::abs(region.upper[axis] - cell.origin[axis] - length) <= tolerance;
}

/// The cell itself, where it repeats along all axes.
std::optional<Region> region_of_cell(const Section& section, const model::PeriodicCell& cell) {
  for (int k = 0; k < 3; ++k) {
    if (cell.periodic[k]) continue;
    section.report_missing(
        "box", cell.any() ? fmt::format(", which the region needs, as the cell does not repeat along {}",
                                        axis_names[k])
                          : ", which says where the balls go");
    return std::nullopt;
  }
  return Region{
      .lower = cell.origin, .upper = cell.origin + cell.edges.diagonal(), .periodic = cell.periodic};
}

std::optional<Region> read_region(const Section& section, const model::PeriodicCell& cell) {
  if (!section.has("box")) return region_of_cell(section, cell);
  const auto box = section.section("box");
  if (!box) return std::nullopt;
  box->check_keys();
  const auto lower = box->vector("min");
  const auto upper = box->vector("max");
  if (!lower || !upper) return std::nullopt;
  Region region{.lower = *lower, .upper = *upper};
  for (int k = 0; k < 3; ++k) {
    if (!(region.lower[k] < region.upper[k])) {
      box->report("max", fmt::format("{0} = {1} m is not above the {0} = {2} m of min", axis_names[k],
                                     region.upper[k], region.lower[k]));
      return std::nullopt;
    }
    if (!cell.periodic[k]) continue;
    if (spans(region, cell, k)) {
      region.periodic[k] = true;
      region.lower[k] = cell.origin[k];
      region.upper[k] = cell.origin[k] + cell.edges(k, k);
    } else if (region.lower[k] < cell.origin[k] || region.upper[k] > cell.origin[k] + cell.edges(k, k)) {
      box->report(fmt::format("reaches out of the periodic cell, which spans {} to {} m along {}",
                              cell.origin[k], cell.origin[k] + cell.edges(k, k), axis_names[k]));
      return std::nullopt;
    }
  }
  return region;
}

/// Adds what `make` returns; a mistake that it finds is one of the key.
template <class Make>
void add_made(const Section& section, std::string_view key, const BallKind& kind, BallList& balls,
              const Make& make) {
  Balls made;
  try {
    made = make();
  } catch (const InputError& error) {
    for (const Mistake& mistake : error.mistakes()) section.report(key, mistake.message);
    return;
  }
  add(made, section, kind, balls);
}

/// The distance of nearest neighbours that `spacing` or `overlap` asks for: a diameter, if neither does.
std::optional<double> read_spacing(const Section& section, double radius) {
  if (section.has("spacing") && section.has("overlap")) {
    section.report("overlap", "beside spacing, which says the same; remove one of the two");
    return std::nullopt;
  }
  if (section.has("spacing")) return section.quantity("spacing");
  if (!section.has("overlap")) return 2 * radius;
  const auto overlap = section.quantity("overlap");
  if (!overlap) return std::nullopt;
  if (*overlap < 2 * radius) return 2 * radius - *overlap;
  section.report("overlap", fmt::format("{} m is not less than the diameter of {} m", *overlap, 2 * radius));
  return std::nullopt;
}

/// What an entry with `fill` asks for.
struct FillWish {
  bool dense = false;
  Region region;
  double fraction = 0;
  std::optional<double> mean_overlap;
  generate::SizeDistribution sizes;
  std::uint64_t seed = 0;
};

/// Where a mean overlap is wanted, the balls are as many as make this fraction: equal balls jam near it, so
/// that their radii change little.
constexpr double fraction_before_compression = 0.64;

/// The fraction or the mean overlap; whether one of them is there.
bool read_density(const Section& section, FillWish& wish) {
  if (!wish.dense && section.has("mean_overlap")) {
    section.report("mean_overlap",
                   "has no meaning with fill: random, which leaves no overlaps; take fill: dense");
    return false;
  }
  if (section.has("fraction") == section.has("mean_overlap")) {
    if (section.has("fraction"))
      section.report("mean_overlap", "beside fraction; one follows from the other, remove one of the two");
    else
      section.report_missing("fraction", wish.dense ? ", or mean_overlap" : "");
    return false;
  }
  if (section.has("mean_overlap")) wish.mean_overlap = section.quantity("mean_overlap");
  const auto fraction = section.has("fraction") ? section.quantity("fraction") : fraction_before_compression;
  wish.fraction = fraction.value_or(0);
  return section.has("mean_overlap") ? wish.mean_overlap.has_value() : fraction.has_value();
}

std::optional<FillWish> read_wish(const Section& section, const SceneDraft& draft) {
  FillWish wish;
  const auto fill = section.text("fill");
  wish.dense = fill && *fill == "dense";
  const bool density = read_density(section, wish);
  const auto sizes = read_sizes(section);
  const auto region = read_region(section, draft.scene.cell);
  const auto seed = section.integer("seed");
  if (!fill || !density || !sizes || !region || !seed) return std::nullopt;
  wish.sizes = *sizes;
  wish.region = *region;
  wish.seed = static_cast<std::uint64_t>(*seed + draft.repetition);
  return wish;
}

std::string text_of(const generate::DensePacking& packing) {
  std::string text = fmt::format("{} balls at a solid fraction of {:.5f}",
                                 grouped(std::ssize(packing.balls.radius)), packing.fraction);
  if (packing.largest_overlap > 0)
    text += fmt::format(
        "; they overlap by {:.3g} of r_a + r_b on average and {:.3g} at most, {:.3f} contacts a ball",
        packing.mean_overlap, packing.largest_overlap, packing.coordination);
  else
    text += "; none overlap";
  if (packing.scale != 1) text += fmt::format("; radii are {:.6f} times those given", packing.scale);
  if (!packing.at_rest)
    text += fmt::format("; not yet in equilibrium after {} iterations", grouped(packing.iterations));
  return text;
}

/// Makes the balls, and says in `note` what came of it.
Balls fill(const FillWish& wish, std::string& note) {
  generate::Random random(wish.seed);
  const generate::SizeSampler sampler(wish.sizes);
  std::vector<double> radii = generate::draw_radii(sampler, wish.fraction * wish.region.volume(), random);
  if (wish.dense) {
    generate::DensePacking packing =
        wish.mean_overlap
            ? generate::pack_to_overlap(std::move(radii), wish.region, *wish.mean_overlap, random)
            : generate::pack_densely(std::move(radii), wish.region, random);
    note = text_of(packing);
    return std::move(packing.balls);
  }
  Balls balls = generate::fill_at_random(radii, wish.region, random);
  note = fmt::format("{} balls at a solid fraction of {:.5f}; none overlap",
                     grouped(std::ssize(balls.radius)), generate::solid_fraction(balls.radius, wish.region));
  return balls;
}

}  // namespace

void read_lattice(const Section& section, const BallKind& kind, const SceneDraft& draft, BallList& balls) {
  const auto name = section.text("lattice");
  const auto radius = section.quantity("radius");
  const auto region = read_region(section, draft.scene.cell);
  if (!section.has("radius")) section.report_missing("radius");
  if (!name || !radius || !region) return;
  const auto spacing = read_spacing(section, *radius);
  if (!spacing) return;
  add_made(section, "lattice", kind, balls, [&] {
    return generate::fill_with_lattice(*generate::find_lattice(*name), *radius, *spacing, *region);
  });
}

void read_fill(const Section& section, const BallKind& kind, SceneDraft& draft, BallList& balls) {
  const auto wish = read_wish(section, draft);
  if (!wish || kind.material < 0) return;  // a packing may take minutes, and this scene is refused anyway
  std::string note;
  add_made(section, "fill", kind, balls, [&] { return fill(*wish, note); });
  if (!note.empty()) draft.scene.notes.push_back(fmt::format("{}: {}", section.path(), note));
}

}  // namespace eigengrain::io
