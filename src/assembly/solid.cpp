#include "eigengrain/assembly/solid.hpp"

#include "eigengrain/assembly/model.hpp"
#include "eigengrain/base/error.hpp"
#include "eigengrain/base/parallel.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace eigengrain::assembly {
namespace {

constexpr std::int64_t chunk_size = 512;

std::size_t at(std::int64_t index) {
  return static_cast<std::size_t>(index);
}

/// Rows of the nodes of a deformable body.
std::vector<std::int32_t> rows_of(const model::Deformable& deformable, const model::Bodies& bodies) {
  std::vector<std::int32_t> row(deformable.mesh.nodes.size(), -1);
  for (std::int32_t i = 0; i < bodies.size(); ++i) {
    const std::int64_t node = bodies.identity[at(i)] - deformable.first_node;
    if (node >= 0 && node < std::ssize(row)) row[at(node)] = i;
  }
  if (std::ranges::find(row, -1) != row.end())
    throw InputError(fmt::format("{}: {} nodes, but the bodies from identity {} on are fewer",
                                 deformable.name, row.size(), deformable.first_node));
  return row;
}

/// Elements in the order of their first rows: what is near in space is then near in memory.
std::vector<std::int32_t> order_of(const model::Mesh& mesh, std::span<const std::int32_t> row) {
  std::vector<std::int32_t> order(at(mesh.element_count()));
  std::iota(order.begin(), order.end(), 0);
  std::vector<std::int32_t> first(order.size());
  for (const std::int32_t e : order) {
    std::int32_t least = row[at(mesh.element(e)[0])];
    for (const std::int32_t node : mesh.element(e)) least = std::min(least, row[at(node)]);
    first[at(e)] = least;
  }
  std::ranges::stable_sort(order, {}, [&](std::int32_t e) { return first[at(e)]; });
  return order;
}

void put_in_order(model::Mesh& mesh, std::span<const std::int32_t> order) {
  std::vector<std::int32_t> elements;
  elements.reserve(mesh.elements.size());
  for (const std::int32_t e : order)
    elements.insert(elements.end(), mesh.element(e).begin(), mesh.element(e).end());
  mesh.elements = std::move(elements);
}

}  // namespace

Solid::Solid(model::Deformable what, const model::Bodies& bodies)
    : deformable(std::move(what)),
      number(order_of(deformable.mesh, rows_of(deformable, bodies))),
      elements((put_in_order(deformable.mesh, number), deformable.mesh)),
      row(rows_of(deformable, bodies)) {
  rows.reserve(deformable.mesh.elements.size());
  for (const std::int32_t node : deformable.mesh.elements) rows.push_back(row[at(node)]);
  corners = group_by_row(deformable.mesh.node_count(), deformable.mesh.elements);
  std::vector<std::int32_t> nodes;
  skin = model::skin_of(deformable.mesh, nodes);
  skin.material = deformable.material;
  skin.name = deformable.name;
  for (const std::int32_t node : nodes) skin_row.push_back(row[at(node)]);
  neighbours = model::neighbours_of(skin);
}

model::Bodies nodes_of(const model::Deformable& deformable) {
  model::Bodies nodes;
  nodes.position = deformable.mesh.nodes;
  nodes.mass = fem::lumped_masses(deformable.mesh, deformable.density);
  const std::size_t count = nodes.mass.size();
  for (std::size_t i = 0; i < count; ++i)
    nodes.identity.push_back(deformable.first_node + static_cast<std::int64_t>(i));
  nodes.radius.assign(count, 0.0);
  // What it would turn against must not be zero.
  for (const double mass : nodes.mass)
    nodes.inertia.push_back(mass * std::pow(mass / deformable.density, 2.0 / 3));
  nodes.material.assign(count, deformable.material);
  model::FixedComponents never_turns;
  for (int k = 3; k < 6; ++k) never_turns.fix(k);
  nodes.fixed.assign(count, never_turns);
  return nodes;
}

void set_solids(Model& model, std::span<const model::Deformable> deformables) {
  model.solids.clear();
  if (deformables.empty()) return;
  std::vector<std::shared_ptr<Solid>> made;
  const std::size_t rigid = model.surfaces.size();
  for (const model::Deformable& deformable : deformables) {
    made.push_back(std::make_shared<Solid>(deformable, model.bodies));
    model.surfaces.push_back(made.back()->skin);
  }
  model.facets = model::facets_of(model.surfaces);
  model.facets.body.assign(model.facets.vertex_normal.size(), -1);
  std::int32_t facet = 0;
  std::int32_t vertex = 0;
  for (std::size_t s = 0; s < model.surfaces.size(); ++s) {
    if (s >= rigid) {
      Solid& solid = *made[s - rigid];
      solid.first_facet = facet;
      solid.first_vertex = vertex;
      std::ranges::copy(solid.skin_row, model.facets.body.begin() + vertex);
      model.surface_places.push_back(
          {.start = model.surfaces[s].centre, .pose = {.centre = model.surfaces[s].centre}});
    }
    facet += static_cast<std::int32_t>(model.surfaces[s].triangles.size());
    vertex += static_cast<std::int32_t>(model.surfaces[s].vertices.size());
  }
  for (std::shared_ptr<Solid>& solid : made) model.solids.push_back(std::move(solid));
  renew_skins(model);
}

void place_skins(const Solids& solids, std::span<const Vec3> position, model::Facets& facets) {
  std::vector<Vec3> place;
  for (const auto& solid : solids) {
    place.clear();
    for (const std::int32_t row : solid->skin_row) place.push_back(position[at(row)]);
    model::place_facets(facets, solid->first_facet, solid->first_vertex, solid->neighbours, place);
  }
}

void renew_skins(Model& model) {
  if (model.solids.empty()) return;
  place_skins(model.solids, model.bodies.position, model.facets);
  const std::size_t rigid = model.surfaces.size() - model.solids.size();
  model.facet_trees.erase(model.facet_trees.begin() + static_cast<std::ptrdiff_t>(rigid),
                          model.facet_trees.end());
  for (const auto& solid : model.solids)
    model.facet_trees.emplace_back(
        std::span(model.facets.facet).subspan(at(solid->first_facet), solid->neighbours.size()),
        solid->first_facet);
}

void SolidForces::add(const Solids& solids, std::span<const Vec3> position, std::span<Vec3> force) {
  for (const auto& shared : solids) {
    const Solid& solid = *shared;
    const auto n = static_cast<std::size_t>(solid.elements.nodes());
    of_corner_.resize(std::max(of_corner_.size(), solid.rows.size()));
    for_chunks(solid.elements.size(), chunk_size, [&](std::int64_t begin, std::int64_t end, std::int64_t) {
      std::array<Vec3, fem::most_nodes> x;
      for (auto e = static_cast<std::int32_t>(begin); e < end; ++e) {
        solid.gather(e, position, x);
        solid.elements.forces(solid.deformable.solid, e, std::span(x).first(n),
                              std::span(of_corner_).subspan(n * at(e), n));
      }
    });
    for_chunks(solid.deformable.mesh.node_count(), chunk_size,
               [&](std::int64_t begin, std::int64_t end, std::int64_t) {
                 for (auto node = static_cast<std::int32_t>(begin); node < end; ++node) {
                   Vec3 sum = Vec3::Zero();
                   for (const std::int32_t corner : solid.corners.links(node)) sum += of_corner_[at(corner)];
                   force[at(solid.row[at(node)])] += sum;
                 }
               });
  }
}

void check_solids(const Solids& solids, std::span<const Vec3> position, std::span<const Vec3> force) {
  for (const auto& shared : solids) {
    const Solid& solid = *shared;
    const auto bad =
        std::ranges::find_if(solid.row, [&](std::int32_t row) { return force[at(row)].hasNaN(); });
    if (bad == solid.row.end()) continue;
    const auto n = static_cast<std::size_t>(solid.elements.nodes());
    std::array<Vec3, fem::most_nodes> x;
    for (std::int32_t e = 0; e < solid.elements.size(); ++e) {
      solid.gather(e, position, x);
      double least = 1;
      for (int q = 0; q < solid.elements.points(); ++q)
        least = std::min(least, solid.elements.deformation(e, q, std::span(x).first(n)).determinant());
      if (least > 0) continue;
      throw SolverError(
          fmt::format("{}: element {} near ({:.4g}, {:.4g}, {:.4g}) m was pressed inside out (volume times "
                      "{:.3g}): a softer "
                      "start, smaller steps or a stiffer or finer mesh is needed",
                      solid.deformable.name, solid.number[at(e)], x[0].x(), x[0].y(), x[0].z(), least));
    }
    const Vec3& place = position[at(*bad)];
    throw SolverError(fmt::format("{}: the force on its node at ({:.4g}, {:.4g}, {:.4g}) m is not a number",
                                  solid.deformable.name, place.x(), place.y(), place.z()));
  }
}

double elastic_energy_of(const Solids& solids, std::span<const Vec3> position) {
  double energy = 0;
  for (const auto& shared : solids) {
    const Solid& solid = *shared;
    const auto n = static_cast<std::size_t>(solid.elements.nodes());
    std::vector<double> parts(at((solid.elements.size() + chunk_size - 1) / chunk_size), 0.0);
    for_chunks(
        solid.elements.size(), chunk_size, [&](std::int64_t begin, std::int64_t end, std::int64_t chunk) {
          std::array<Vec3, fem::most_nodes> x;
          for (auto e = static_cast<std::int32_t>(begin); e < end; ++e) {
            solid.gather(e, position, x);
            parts[at(chunk)] += solid.elements.energy(solid.deformable.solid, e, std::span(x).first(n));
          }
        });
    for (const double part : parts) energy += part;
  }
  return energy;
}

}  // namespace eigengrain::assembly
