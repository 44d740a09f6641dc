#include "eigengrain/generate/lattice.hpp"

#include "eigengrain/base/error.hpp"
#include "eigengrain/base/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>

namespace eigengrain::generate {
namespace {

std::vector<Lattice> all_lattices() {
  const std::vector<Vec3> face_centred{{0, 0, 0}, {.5, .5, 0}, {.5, 0, .5}, {0, .5, .5}};
  std::vector<Vec3> diamond = face_centred;
  for (const Vec3& site : face_centred) diamond.emplace_back(site + Vec3::Constant(.25));
  return {
      {.name = "sc", .cell = Vec3::Ones(), .sites = {{0, 0, 0}}},
      {.name = "bcc", .cell = Vec3::Constant(2 / std::sqrt(3.0)), .sites = {{0, 0, 0}, {.5, .5, .5}}},
      {.name = "fcc", .cell = Vec3::Constant(std::sqrt(2.0)), .sites = face_centred},
      {.name = "hcp",
       .cell = {1, std::sqrt(3.0), std::sqrt(8.0 / 3)},
       .sites = {{0, 0, 0}, {.5, .5, 0}, {0, 1.0 / 3, .5}, {.5, 5.0 / 6, .5}}},
      {.name = "diamond", .cell = Vec3::Constant(4 / std::sqrt(3.0)), .sites = diamond},
      {.name = "square", .cell = {1, 1, 0}, .sites = {{0, 0, 0}}, .planar = true},
      {.name = "hexagonal",
       .cell = {1, std::sqrt(3.0), 0},
       .sites = {{0, 0, 0}, {.5, .5, 0}},
       .planar = true},
  };
}

/// The sites along one axis.
struct Axis {
  double start = 0;   ///< coordinate of the first site, m
  double length = 0;  ///< of all cells, m
  double room = 0;    ///< how far from start a site may lie, m; without limit where periodic
  double cells = 1;   ///< whole

  double offset(double cell, double fraction) const { return length * ((cell + fraction) / cells); }
};

Axis open_axis(double lower, double upper, double radius, double edge) {
  const double room = upper - lower - 2 * radius + negligible * edge;
  const double cells = std::floor(std::max(room, 0.0) / edge) + 1;
  return {.start = lower + radius, .length = cells * edge, .room = std::max(room, 0.0), .cells = cells};
}

/// What is wrong with the length of a periodic axis; empty where it fits.
std::string misfit(double length, double edge, char name) {
  const double cells = std::max(1.0, std::round(length / edge));
  if (std::abs(length - cells * edge) <= negligible * length) return {};
  return fmt::format(
      "along {} the cell is {} m long, {:.6g} times the lattice's {:.6g} m; the nearest length that fits is "
      "{} m",
      name, length, length / edge, edge, cells * edge);
}

std::array<Axis, 3> axes_of(const Lattice& lattice, double radius, double spacing, const Region& region) {
  constexpr std::string_view names = "xyz";
  std::array<Axis, 3> axes;
  std::string misfits;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto axis = static_cast<Eigen::Index>(k);
    const double lower = region.lower[axis];
    const double upper = region.upper[axis];
    if (lattice.planar && k == 2) {
      axes[k] = {.start = lower + 0.5 * (upper - lower)};
      continue;
    }
    const double edge = lattice.cell[axis] * spacing;
    if (!region.periodic[k]) {
      axes[k] = open_axis(lower, upper, radius, edge);
      continue;
    }
    axes[k] = {.start = lower,
               .length = upper - lower,
               .room = upper - lower,
               .cells = std::max(1.0, std::round((upper - lower) / edge))};
    const std::string text = misfit(upper - lower, edge, names[k]);
    if (!text.empty()) misfits += (misfits.empty() ? "" : "; ") + text;
  }
  if (!misfits.empty()) throw InputError("the lattice does not repeat with the cell: " + misfits);
  return axes;
}

}  // namespace

std::span<const Lattice> lattices() {
  static const std::vector<Lattice> all = all_lattices();
  return all;
}

const Lattice* find_lattice(std::string_view name) {
  for (const Lattice& lattice : lattices())
    if (lattice.name == name) return &lattice;
  return nullptr;
}

Balls fill_with_lattice(const Lattice& lattice, double radius, double spacing, const Region& region) {
  require_room(radius, region);
  const auto [x, y, z] = axes_of(lattice, radius, spacing, region);
  const double count = x.cells * y.cells * z.cells * static_cast<double>(lattice.sites.size());
  if (count > static_cast<double>(most_balls))
    throw InputError(fmt::format("{:.3g} balls, and no more than {} can be made; are the units right?", count,
                                 grouped(most_balls)));
  Balls balls;
  balls.position.reserve(static_cast<std::size_t>(count));
  balls.radius.reserve(static_cast<std::size_t>(count));
  for (double k = 0; k < z.cells; ++k)
    for (double j = 0; j < y.cells; ++j)
      for (double i = 0; i < x.cells; ++i)
        for (const Vec3& site : lattice.sites) {
          const Vec3 offset(x.offset(i, site.x()), y.offset(j, site.y()), z.offset(k, site.z()));
          if (offset.x() <= x.room && offset.y() <= y.room && offset.z() <= z.room)
            balls.add(Vec3(x.start, y.start, z.start) + offset, radius);
        }
  return balls;
}

}  // namespace eigengrain::generate
