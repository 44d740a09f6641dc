#include "eigengrain/assembly/bonds.hpp"

#include "eigengrain/assembly/contact_list.hpp"
#include "eigengrain/base/error.hpp"
#include "eigengrain/contact/bonds.hpp"
#include "eigengrain/search/candidates.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

namespace eigengrain::assembly {
namespace {

using contact::AnyGroup;
using contact::BallBall;
using contact::BondLaw;
using contact::ContactGroup;
using contact::Pair;
using contact::precedes;

/// What `from_values` of a bond wants: a bond that is the law itself has the law's values in front.
template <BondLaw Bond>
std::vector<double> values_for(const model::ContactRule& rule, std::int32_t index) {
  const std::vector<double>& own = rule.bond->parameters;
  if constexpr (Bond::additive) {
    return own;
  } else {
    if (rule.law != contact::Linear::name)
      throw InputError(fmt::format("contacts[{}]: a {} bond is one of the law \"{}\", not of \"{}\"", index,
                                   Bond::name, contact::Linear::name, rule.law));
    std::vector<double> values = law_values(rule, index, contact::Linear::parameters);
    values.insert(values.end(), own.begin(), own.end());
    return values;
  }
}

/// A pair that is to be bonded, sorted as contacts are.
struct NewBond {
  Pair pair;
  contact::BondSite site;
};

/// [rules] the pairs to be bonded.
std::vector<std::vector<NewBond>> pairs_to_bond(const Model& model, const model::Scene& scene, double reach) {
  std::vector<std::vector<NewBond>> result(scene.contacts.size());
  const model::Bodies& bodies = model.bodies;
  const contact::Placement placement = model.placement();
  const auto orientation = [&](std::size_t body) {
    return bodies.orientation.empty() ? Quat(Quat::Identity()) : bodies.orientation[body];
  };
  for (const auto& found : search::candidate_pairs(bodies.position, bodies.radius, model.cell, reach)) {
    const Pair pair{found.a, found.b, found.image};
    const auto a = static_cast<std::size_t>(pair.a);
    const auto b = static_cast<std::size_t>(pair.b);
    if (bodies.clumps.same(pair.a, pair.b) && pair.image == model::Image{}) continue;
    const std::int32_t rule = scene.rule_for(bodies.material[a], bodies.material[b]);
    if (rule < 0) continue;
    const auto& bond = scene.contacts[static_cast<std::size_t>(rule)].bond;
    const contact::ContactGeometry geometry = BallBall::geometry(placement, pair);
    if (!bond || -geometry.overlap > bond->gap) continue;
    result[static_cast<std::size_t>(rule)].push_back(
        {pair, {geometry, bodies.radius[a], bodies.radius[b], orientation(a), orientation(b)}});
  }
  return result;
}

/// Puts bonds into a sorted group, in the place of unbonded contacts of the same pairs.
template <class Group>
void add_bonds(Group& group, const std::vector<NewBond>& bonds) {
  Group merged{group.law, group.rule, {}, {}};
  const auto add = [&](const Pair& pair, const typename Group::State& state) {
    merged.pairs.push_back(pair);
    merged.states.push_back(state);
  };
  std::size_t old = 0;
  for (const NewBond& bond : bonds) {
    for (; old < group.pairs.size() && precedes(group.pairs[old], bond.pair); ++old)
      add(group.pairs[old], group.states[old]);
    if (old < group.pairs.size() && !precedes(bond.pair, group.pairs[old])) ++old;
    add(bond.pair, group.law.bond(bond.site));
  }
  for (; old < group.pairs.size(); ++old) add(group.pairs[old], group.states[old]);
  group = std::move(merged);
}

/// The group of the model that holds the bonds of a rule; a new one where there is none.
AnyGroup& group_for(Model& model, const model::ContactRule& rule, std::int32_t index) {
  AnyGroup empty = new_bond_group(rule, index);
  for (AnyGroup& group : model.contacts.groups)
    if (group.index() == empty.index() && std::visit([&](const auto& g) { return g.rule == index; }, group))
      return group;
  return model.contacts.groups.emplace_back(std::move(empty));
}

}  // namespace

AnyGroup new_bond_group(const model::ContactRule& rule, std::int32_t index) {
  std::optional<AnyGroup> group;
  bool known = false;
  for_each_type(contact::BondTypes{}, [&](auto tag) {
    using Bond = typename decltype(tag)::type;
    static_assert(BondLaw<Bond>);
    if (group || Bond::name != rule.bond->kind) return;
    if (rule.bond->parameters.size() != Bond::parameters.size())
      throw InputError(fmt::format("contacts[{}].bond: {} parameters; the kind \"{}\" takes {}", index,
                                   rule.bond->parameters.size(), Bond::name, Bond::parameters.size()));
    known = true;
    const std::vector<double> values = values_for<Bond>(rule, index);
    if (Bond::serves(values)) group = ContactGroup<BallBall, Bond>{Bond::from_values(values), index, {}, {}};
  });
  if (!group)
    throw InputError(fmt::format(fmt::runtime(known ? "contacts[{}].bond: no \"{}\" bond goes with all "
                                                      "parameters of the law"
                                                    : "contacts[{}].bond: there is no kind \"{}\""),
                                 index, rule.bond->kind));
  return std::move(*group);
}

bool needs_orientation(const model::Scene& scene) {
  bool needed = false;
  for (std::size_t r = 0; r < scene.contacts.size(); ++r) {
    if (!scene.contacts[r].bond) continue;
    const AnyGroup group = new_bond_group(scene.contacts[r], static_cast<std::int32_t>(r));
    needed = needed || std::visit(
                           [](const auto& g) {
                             return contact::in_total_form<typename std::decay_t<decltype(g)>::LawType>;
                           },
                           group);
  }
  return needed;
}

void make_bonds(Model& model, const model::Scene& scene) {
  double reach = 0;
  bool any = false;
  for (const model::ContactRule& rule : scene.contacts) {
    if (!rule.bond) continue;
    any = true;
    reach = std::max(reach, rule.bond->gap);
  }
  if (!any) return;
  const std::vector<std::vector<NewBond>> found = pairs_to_bond(model, scene, reach);
  for (std::size_t r = 0; r < found.size(); ++r) {
    if (found[r].empty()) continue;
    std::visit(
        [&](auto& group) {
          if constexpr (BondLaw<typename std::decay_t<decltype(group)>::LawType>) add_bonds(group, found[r]);
        },
        group_for(model, scene.contacts[r], static_cast<std::int32_t>(r)));
  }
}

void carry_bonds(const contact::Contacts& before, Model& model) {
  before.for_each_group([&](const auto& group) {
    using Group = std::decay_t<decltype(group)>;
    if constexpr (BondLaw<typename Group::LawType>) {
      if (!Group::LawType::additive) return;
      Group kept{group.law, group.rule, {}, {}};
      for (std::size_t c = 0; c < group.pairs.size(); ++c) {
        if (!group.states[c].bonded()) continue;
        kept.pairs.push_back(group.pairs[c]);
        kept.states.push_back(group.states[c]);
      }
      if (!kept.pairs.empty()) model.contacts.groups.emplace_back(std::move(kept));
    }
  });
}

std::int64_t count_bonds(const Model& model) {
  std::int64_t count = 0;
  model.contacts.for_each_group([&](const auto& group) {
    if constexpr (BondLaw<typename std::decay_t<decltype(group)>::LawType>)
      count += std::count_if(group.states.begin(), group.states.end(),
                             [](const auto& state) { return state.bonded(); });
  });
  return count;
}

}  // namespace eigengrain::assembly
