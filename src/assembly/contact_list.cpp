#include "eigengrain/assembly/contact_list.hpp"

#include "eigengrain/assembly/bonds.hpp"
#include "eigengrain/assembly/surroundings.hpp"
#include "eigengrain/base/error.hpp"
#include "eigengrain/base/parallel.hpp"
#include "eigengrain/contact/facet_choice.hpp"
#include "eigengrain/search/candidates.hpp"

#include "wrap.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <type_traits>
#include <utility>

namespace eigengrain::assembly {
namespace {

using contact::AnyGroup;
using contact::ContactGroup;
using contact::Pair;
using contact::precedes;

/// Whether the bonds of a rule are in the group of its law (a contact bond), not beside it.
bool bond_is_law(const model::ContactRule& rule) {
  bool result = false;
  for_each_type(contact::BondTypes{}, [&](auto tag) {
    using Bond = typename decltype(tag)::type;
    if (Bond::name == rule.bond->kind) result = !Bond::additive;
  });
  return result;
}

template <class Kinematics>
AnyGroup new_group(const model::ContactRule& rule, std::int32_t index) {
  std::optional<AnyGroup> group;
  if constexpr (std::is_same_v<Kinematics, contact::BallBall>)
    if (rule.bond && bond_is_law(rule)) return new_bond_group(rule, index);
  for_each_type(contact::LawTypes{}, [&](auto tag) {
    using Law = typename decltype(tag)::type;
    if (group || Law::name != rule.law) return;
    const std::vector<double> values = law_values(rule, index, Law::parameters);
    if (Law::serves(values)) group = ContactGroup<Kinematics, Law>{Law::from_values(values), index, {}, {}};
  });
  if (!group) throw InputError(fmt::format("contacts[{}]: there is no law \"{}\"", index, rule.law));
  return std::move(*group);
}

/// Rule for each pair of materials, looked up once: [materials × materials], -1 where none.
class RuleTable {
 public:
  explicit RuleTable(const model::Scene& scene) : materials_(scene.materials.size()) {
    for (std::size_t a = 0; a < materials_; ++a)
      for (std::size_t b = 0; b < materials_; ++b)
        rules_.push_back(scene.rule_for(static_cast<std::int32_t>(a), static_cast<std::int32_t>(b)));
  }
  std::int32_t operator()(std::int32_t a, std::int32_t b) const {
    return rules_[static_cast<std::size_t>(a) * materials_ + static_cast<std::size_t>(b)];
  }

 private:
  std::size_t materials_;
  std::vector<std::int32_t> rules_;
};

/// A contact that acts by an entry that was chosen for it (assembly/choose_contacts.hpp).
struct ChosenContact {
  Pair pair;
  std::int32_t rule = 0;
};

/// Those of a kinematics, sorted.
template <class Kinematics>
std::vector<ChosenContact> chosen_contacts(const model::Scene& scene, const Model& model,
                                           const contact::Contacts& contacts) {
  std::vector<ChosenContact> chosen;
  if (std::none_of(scene.contacts.begin(), scene.contacts.end(),
                   [](const auto& rule) { return rule.by_choice(); }))
    return chosen;
  const contact::Placement placement = model.placement();
  contacts.for_each_group([&](const auto& group) {
    if constexpr (std::is_same_v<typename std::decay_t<decltype(group)>::KinematicsType, Kinematics>) {
      if (!scene.contacts[static_cast<std::size_t>(group.rule)].by_choice()) return;
      for (std::size_t c = 0; c < group.pairs.size(); ++c)
        if (group.law.acts(contact::at_rest(Kinematics::geometry(placement, group.pairs[c])),
                           group.states[c]))
          chosen.push_back({group.pairs[c], group.rule});
    }
  });
  std::sort(chosen.begin(), chosen.end(),
            [](const ChosenContact& l, const ChosenContact& r) { return precedes(l.pair, r.pair); });
  return chosen;
}

/// Sorts pairs by the rule that holds for them; a pair whose law is "none" is left out.
class PairsByRule {
 public:
  PairsByRule(const model::Scene& scene, std::vector<ChosenContact> chosen)
      : scene_(scene), rule_of_(scene), chosen_(std::move(chosen)), pairs_(scene.contacts.size()) {}

  void add(const Pair& pair, std::int32_t material_a, std::int32_t material_b) {
    const std::int32_t rule = chosen_.empty() ? rule_of_(material_a, material_b)
                                              : chosen_rule(pair, rule_of_(material_a, material_b));
    if (rule < 0) throw InputError(missing_rule(material_a, material_b));
    if (scene_.contacts[rule].law != "none") pairs_[rule].push_back(pair);
  }
  std::vector<Pair>& of(std::int32_t rule) { return pairs_[rule]; }

 private:
  std::int32_t chosen_rule(const Pair& pair, std::int32_t otherwise) const {
    const auto found =
        std::lower_bound(chosen_.begin(), chosen_.end(), pair,
                         [](const ChosenContact& l, const Pair& r) { return precedes(l.pair, r); });
    return found != chosen_.end() && !precedes(pair, found->pair) ? found->rule : otherwise;
  }

  std::string missing_rule(std::int32_t a, std::int32_t b) const {
    const auto name = [&](std::int32_t m) { return scene_.materials[m].name; };
    return fmt::format("no entry of contacts matches {} and {}, which touch; add one with between: [{}, {}]",
                       name(a), name(b), name(a), name(b));
  }

  const model::Scene& scene_;
  RuleTable rule_of_;
  std::vector<ChosenContact> chosen_;
  std::vector<std::vector<Pair>> pairs_;
};

/// Balls of one clump never touch; but they may touch the clump's own image.
bool within_clump(const model::Clumps& clumps, const search::CandidatePair& pair) {
  return !clumps.empty() && clumps.same(pair.a, pair.b) && pair.image == model::Image{};
}

/// Pairs of balls that are near each other. Nodes of deformable bodies are no balls: they are left out.
std::vector<search::CandidatePair> candidates(const Model& model, double reach) {
  const model::Bodies& bodies = model.bodies;
  if (model.solids.empty()) return search::candidate_pairs(bodies.position, bodies.radius, model.cell, reach);
  std::vector<std::int32_t> row;
  std::vector<Vec3> position;
  std::vector<double> radius;
  for (std::int32_t i = 0; i < bodies.size(); ++i) {
    const auto ball = static_cast<std::size_t>(i);
    if (is_node(bodies, ball)) continue;
    row.push_back(i);
    position.push_back(bodies.position[ball]);
    radius.push_back(bodies.radius[ball]);
  }
  if (row.empty()) return {};
  std::vector<search::CandidatePair> found = search::candidate_pairs(position, radius, model.cell, reach);
  for (search::CandidatePair& pair : found) {
    pair.a = row[static_cast<std::size_t>(pair.a)];
    pair.b = row[static_cast<std::size_t>(pair.b)];
  }
  return found;
}

PairsByRule ball_ball_pairs(const model::Scene& scene, const Model& model, const contact::Contacts& before,
                            double reach) {
  const model::Bodies& bodies = model.bodies;
  PairsByRule result(scene, chosen_contacts<contact::BallBall>(scene, model, before));
  for (const search::CandidatePair& found : candidates(model, reach)) {
    const auto a = static_cast<std::size_t>(found.a);
    const auto b = static_cast<std::size_t>(found.b);
    if (within_clump(bodies.clumps, found)) continue;
    if (bodies.position[b] + model.cell.shift(found.image) == bodies.position[a])
      throw InputError(fmt::format("balls {} and {} have the same centre ({}, {}, {}); move one of them",
                                   bodies.identity[a], bodies.identity[b], bodies.position[a].x(),
                                   bodies.position[a].y(), bodies.position[a].z()));
    result.add({found.a, found.b, found.image}, bodies.material[a], bodies.material[b]);
  }
  return result;
}

PairsByRule ball_wall_pairs(const model::Scene& scene, const Model& model, const contact::Contacts& before,
                            double reach) {
  const model::Bodies& bodies = model.bodies;
  PairsByRule result(scene, chosen_contacts<contact::BallPlane>(scene, model, before));
  for (std::int32_t i = 0; i < bodies.size(); ++i) {
    const auto ball = static_cast<std::size_t>(i);
    for (std::size_t w = 0; w < model.walls.size(); ++w) {
      const model::Plane& wall = model.walls[w];
      if ((bodies.position[ball] - wall.point).dot(wall.normal) > bodies.radius[ball] + reach) continue;
      result.add({i, static_cast<std::int32_t>(w), {}}, bodies.material[ball], wall.material);
    }
  }
  return result;
}

/// The facets of a surface, or of its periodic images, that a ball is near to, with sides and choice made.
class FacetSearch {
 public:
  /// radii  [surfaces] about their centres, m
  /// known  the pairs with facets that were listed before, sorted: they know on which side their ball is
  FacetSearch(const Model& model, std::span<const double> radii, std::span<const Pair> known, double reach)
      : model_(model), placement_(model.placement()), radius_(radii), known_(known), reach_(reach) {}

  void search(std::int32_t body, std::size_t surface, std::vector<Pair>& result) {
    const auto first = static_cast<std::ptrdiff_t>(result.size());
    const auto ball = static_cast<std::size_t>(body);
    const double range = model_.bodies.radius[ball] + reach_;
    const contact::SurfacePlace& place = model_.surface_places[surface];
    for_each_image(model_.bodies.position[ball] - place.pose.centre, radius_[surface] + range,
                   [&](const model::Image& image) {
                     Pair pair{body, 0, image};
                     const Vec3 x = place.to_local(model_.bodies.position[ball] - model_.cell.shift(image));
                     found_.clear();
                     model_.facet_trees[surface].near(x, range, found_);
                     for (const std::int32_t facet : found_) {
                       pair.b = facet;
                       const auto& f = model_.facets.facet[static_cast<std::size_t>(facet)];
                       if ((contact::nearest_point(x, f).point - x).norm() <= range) result.push_back(pair);
                     }
                   });
    if (std::ssize(result) == first) return;
    std::sort(result.begin() + first, result.end(), precedes);
    for (auto pair = result.begin() + first; pair != result.end(); ++pair) {
      const auto same = std::lower_bound(known_.begin(), known_.end(), *pair, precedes);
      if (same != known_.end() && !precedes(*pair, *same)) pair->side = same->side;
    }
    directions_.resize(result.size());
    contact::choose_facets(placement_, std::span(result).subspan(static_cast<std::size_t>(first)),
                           directions_);
  }

 private:
  /// Calls visit for the images of a surface within `range` of its centre that may be near.
  template <class Visit>
  void for_each_image(const Vec3& apart, double range, const Visit& visit) const {
    std::array<int, 3> low{};
    std::array<int, 3> high{};
    constexpr double most = 127;
    for (int k = 0; k < 3; ++k) {
      if (!model_.cell.periodic[static_cast<std::size_t>(k)]) continue;
      const double length = model_.cell.edges(k, k);  // cells that deform have no surfaces
      low[static_cast<std::size_t>(k)] =
          static_cast<int>(std::max(-most, std::ceil((apart[k] - range) / length)));
      high[static_cast<std::size_t>(k)] =
          static_cast<int>(std::min(most, std::floor((apart[k] + range) / length)));
    }
    for (int i = low[0]; i <= high[0]; ++i)
      for (int j = low[1]; j <= high[1]; ++j)
        for (int k = low[2]; k <= high[2]; ++k)
          visit(model::Image{static_cast<std::int8_t>(i), static_cast<std::int8_t>(j),
                             static_cast<std::int8_t>(k)});
  }

  const Model& model_;
  contact::Placement placement_;
  std::span<const double> radius_;
  std::span<const Pair> known_;
  double reach_;
  std::vector<std::int32_t> found_;
  std::vector<Vec3> directions_;
};

/// The greatest distance of each surface from its centre, m.
std::vector<double> surface_radii(const Model& model) {
  std::vector<double> radii;
  for (const model::Surface& surface : model.surfaces) {
    double radius = 0;
    for (const Vec3& x : surface.vertices) radius = std::max(radius, (x - surface.centre).norm());
    radii.push_back(radius);
  }
  return radii;
}

/// All pairs with facets, sorted.
std::vector<Pair> facet_pairs(const contact::Contacts& contacts) {
  std::vector<Pair> pairs;
  contacts.for_each_group([&](const auto& group) {
    if constexpr (std::is_same_v<typename std::decay_t<decltype(group)>::KinematicsType, contact::BallFacet>)
      pairs.insert(pairs.end(), group.pairs.begin(), group.pairs.end());
  });
  std::sort(pairs.begin(), pairs.end(), precedes);
  return pairs;
}

PairsByRule ball_facet_pairs(const model::Scene& scene, const Model& model, const contact::Contacts& before,
                             double reach) {
  PairsByRule result(scene, chosen_contacts<contact::BallFacet>(scene, model, before));
  if (model.surfaces.empty()) return result;
  constexpr std::int64_t chunk_size = 1024;
  const std::vector<double> radii = surface_radii(model);
  const std::vector<Pair> known = facet_pairs(before);
  const std::int64_t bodies = model.bodies.size();
  std::vector<std::vector<Pair>> chunks(static_cast<std::size_t>((bodies + chunk_size - 1) / chunk_size));
  try {
    for_chunks(bodies, chunk_size, [&](std::int64_t begin, std::int64_t end, std::int64_t chunk) {
      std::vector<Pair> found;
      FacetSearch search(model, radii, known, reach);
      for (std::int64_t body = begin; body < end; ++body) {
        if (is_node(model.bodies, static_cast<std::size_t>(body))) continue;
        for (std::size_t s = 0; s < model.surfaces.size(); ++s)
          search.search(static_cast<std::int32_t>(body), s, found);
      }
      chunks[static_cast<std::size_t>(chunk)] = std::move(found);
    });
  } catch (const contact::CentreOnFacet& found) {
    throw centre_on_facet(model, found);
  }
  for (const std::vector<Pair>& found : chunks)
    for (const Pair& pair : found) {
      const model::Facet& facet = model.facets.facet[static_cast<std::size_t>(pair.b)];
      result.add(pair, model.bodies.material[static_cast<std::size_t>(pair.a)],
                 model.surfaces[static_cast<std::size_t>(facet.surface)].material);
    }
  return result;
}

/// Fills an empty group from the pairs found and the group that was there before; both are sorted.
template <class Group>
void fill(Group& group, const Group* before, const std::vector<Pair>& found, const Model& model,
          bool touching_only, NewContacts touching) {
  using Kinematics = typename Group::KinematicsType;
  using State = typename Group::State;
  const contact::Placement placement = model.placement();
  const auto acts = [&](const Pair& pair, const State& state) {
    return group.law.acts(contact::at_rest(Kinematics::geometry(placement, pair)), state);
  };
  const auto add = [&](const Pair& pair, const State& state) {
    group.pairs.push_back(pair);
    group.states.push_back(state);
  };
  const auto add_new = [&](const Pair& pair) {
    const contact::ContactMotion motion = contact::at_rest(Kinematics::geometry(placement, pair));
    if (group.law.acts(motion, State{}))
      add(pair, touching == NewContacts::formed ? group.law.formed(motion.normal) : State{});
    else if (!touching_only)
      add(pair, State{});
  };
  group.pairs.reserve(found.size());
  group.states.reserve(found.size());
  std::size_t old = 0;
  const std::size_t olds = before != nullptr ? before->pairs.size() : 0;
  const auto keep_lost_until = [&](const Pair* next) {
    for (; old < olds && (next == nullptr || precedes(before->pairs[old], *next)); ++old)
      if (acts(before->pairs[old], before->states[old])) add(before->pairs[old], before->states[old]);
  };
  for (const Pair& pair : found) {
    keep_lost_until(&pair);
    if (old < olds && !precedes(pair, before->pairs[old])) {
      add(before->pairs[old], before->states[old]);
      ++old;
    } else
      add_new(pair);
  }
  keep_lost_until(nullptr);
}

template <class Kinematics>
void list_kind(PairsByRule pairs, const model::Scene& scene, const contact::Contacts& before, Model& model,
               bool touching_only, NewContacts touching) {
  for (std::int32_t rule = 0; rule < static_cast<std::int32_t>(scene.contacts.size()); ++rule) {
    if (scene.contacts[rule].law == "none") continue;
    AnyGroup group = new_group<Kinematics>(scene.contacts[rule], rule);
    const bool some = std::visit(
        [&](auto& concrete) {
          using Group = std::decay_t<decltype(concrete)>;
          if constexpr (std::is_same_v<typename Group::KinematicsType, Kinematics>) {
            const Group* old = nullptr;
            for (const AnyGroup& candidate : before.groups)
              if (const auto* same = std::get_if<Group>(&candidate); same != nullptr && same->rule == rule)
                old = same;
            fill(concrete, old, pairs.of(rule), model, touching_only, touching);
          }
          return !concrete.pairs.empty();
        },
        group);
    if (some) model.contacts.groups.push_back(std::move(group));
  }
}

/// Wrapping changes images, which are a part of the order.
template <class Group>
void sort_contacts(Group& group) {
  if (std::is_sorted(group.pairs.begin(), group.pairs.end(), precedes)) return;
  std::vector<std::size_t> order(group.pairs.size());
  for (std::size_t c = 0; c < order.size(); ++c) order[c] = c;
  std::sort(order.begin(), order.end(),
            [&](std::size_t l, std::size_t r) { return precedes(group.pairs[l], group.pairs[r]); });
  Group sorted{group.law, group.rule, {}, {}};
  for (const std::size_t c : order) {
    sorted.pairs.push_back(group.pairs[c]);
    sorted.states.push_back(group.states[c]);
  }
  group = std::move(sorted);
}

}  // namespace

std::vector<double> law_values(const model::ContactRule& rule, std::int32_t index,
                               std::span<const contact::ParameterDescription> parameters) {
  std::vector<double> values = rule.parameters;
  while (values.size() < parameters.size() && parameters[values.size()].default_value)
    values.push_back(*parameters[values.size()].default_value);
  if (values.size() != parameters.size())
    throw InputError(fmt::format("contacts[{}]: {} parameters; the law \"{}\" takes {}", index,
                                 rule.parameters.size(), rule.law, parameters.size()));
  return values;
}

AnyGroup new_group(std::string_view kinematics, const model::ContactRule& rule, std::int32_t index) {
  std::optional<AnyGroup> group;
  for_each_type(contact::KinematicsTypes{}, [&](auto tag) {
    using Kinematics = typename decltype(tag)::type;
    if (Kinematics::name == kinematics) group = new_group<Kinematics>(rule, index);
  });
  if (!group) throw InputError(fmt::format("there is no contact kinematics \"{}\"", kinematics));
  return std::move(*group);
}

bool needs_rotation(const model::Scene& scene) {
  bool turns = false;
  const auto ask = [&](const AnyGroup& group) {
    turns = turns || std::visit([](const auto& g) { return g.law.needs_rotation(); }, group);
  };
  for (std::size_t r = 0; r < scene.contacts.size(); ++r) {
    const model::ContactRule& rule = scene.contacts[r];
    if (rule.bond) ask(new_bond_group(rule, static_cast<std::int32_t>(r)));
    if (rule.law != "none") ask(new_group<contact::BallBall>(rule, static_cast<std::int32_t>(r)));
  }
  return turns;
}

void list_contacts(Model& model, const model::Scene& scene, double reach, NewContacts touching) {
  wrap(model);
  renew_skins(model);
  contact::Contacts before = std::exchange(model.contacts, {});
  before.for_each_group([](auto& group) { sort_contacts(group); });
  const bool touching_only = reach <= 0;
  list_kind<contact::BallBall>(ball_ball_pairs(scene, model, before, reach), scene, before, model,
                               touching_only, touching);
  list_kind<contact::BallPlane>(ball_wall_pairs(scene, model, before, reach), scene, before, model,
                                touching_only, touching);
  list_kind<contact::BallFacet>(ball_facet_pairs(scene, model, before, reach), scene, before, model,
                                touching_only, touching);
  carry_bonds(before, model);
}

void begin_list(State& state) {
  NeighbourList& list = state.list;
  list.position = state.model.bodies.position;
  list.edges = state.model.cell.edges;
  list.wall_way = 0;
  list.growth = 0;
  list.wall_lever.clear();
  for (const model::WallPose& pose : state.model.wall_poses) {
    double farthest = 0;
    for (const Vec3& x : list.position) farthest = std::max(farthest, (x - pose.centre).norm());
    // While the list holds, body and centre may each move by half the skin.
    list.wall_lever.push_back(farthest + list.skin);
  }
}

void renew_list(State& state, double reach) {
  list_contacts(state.model, state.settings, reach, NewContacts::unformed);
  begin_list(state);
  ++state.list.rebuilds;
}

}  // namespace eigengrain::assembly
