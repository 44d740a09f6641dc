#include "eigengrain/assembly/choose_contacts.hpp"

#include "eigengrain/assembly/contact_list.hpp"
#include "eigengrain/assembly/forces.hpp"
#include "eigengrain/assembly/selection.hpp"
#include "eigengrain/assembly/surroundings.hpp"
#include "eigengrain/base/error.hpp"
#include "eigengrain/contact/state_numbers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <type_traits>
#include <utility>
#include <vector>

namespace eigengrain::assembly {
namespace {

using contact::AnyGroup;

/// A contact without the type of its law.
struct LooseContact {
  contact::Pair pair;
  std::vector<contact::NamedNumbers> history;
};

std::int32_t rule_of(const model::Scene& settings, const std::string& name, const std::string& where) {
  const auto found = std::find_if(settings.contacts.begin(), settings.contacts.end(),
                                  [&](const model::ContactRule& rule) { return rule.name == name; });
  if (found == settings.contacts.end())
    throw InputError(fmt::format("{}: no entry of contacts has the name \"{}\"", where, name));
  return static_cast<std::int32_t>(found - settings.contacts.begin());
}

/// What makes a contact one of those that are meant.
class Choice {
 public:
  Choice(const State& state, const model::ContactChoice& choice, const std::string& where)
      : model_(state.model), selected_(static_cast<std::size_t>(state.model.bodies.size()), 0) {
    for (const std::int32_t row : selected(model_.bodies, state.groups, choice.of, where))
      selected_[static_cast<std::size_t>(row)] = 1;
    if (!choice.wall) return;
    wall_ = find_wall(model_, *choice.wall, where);
    if (static_cast<std::size_t>(*wall_) >= model_.walls.size())
      throw InputError(fmt::format(
          "{}: {} is a surface of triangles, whose contacts keep the entry of their materials; name a plane",
          where, *choice.wall));
  }

  template <class Kinematics>
  bool means(const contact::Placement& placement, const contact::Pair& pair) const {
    if (selected_[static_cast<std::size_t>(pair.a)] == 0) return false;
    if constexpr (Kinematics::second_is_body)
      return !wall_ && selected_[static_cast<std::size_t>(pair.b)] != 0;
    else
      return !wall_ || Kinematics::wall(placement, pair) == *wall_;
  }

 private:
  const Model& model_;
  std::vector<char> selected_;
  std::optional<std::int32_t> wall_;
};

/// Takes the contacts that are meant out of a group.
template <class Group>
std::vector<LooseContact> take_out(Group& group, const Model& model, const Choice& choice) {
  using Kinematics = typename Group::KinematicsType;
  using Law = typename Group::LawType;
  std::vector<LooseContact> taken;
  // The triangles of a surface share out what a ball feels of it, so their pairs stay together.
  if constexpr (!contact::BondLaw<Law> && !std::is_same_v<Kinematics, contact::BallFacet>) {
    const contact::Placement placement = model.placement();
    std::size_t kept = 0;
    for (std::size_t c = 0; c < group.pairs.size(); ++c) {
      const contact::Pair& pair = group.pairs[c];
      if (choice.means<Kinematics>(placement, pair) &&
          group.law.acts(contact::at_rest(Kinematics::geometry(placement, pair)), group.states[c])) {
        taken.push_back({pair, contact::numbers_of<Law>(group.states[c])});
        continue;
      }
      group.pairs[kept] = pair;
      group.states[kept] = group.states[c];
      ++kept;
    }
    group.pairs.resize(kept);
    group.states.resize(kept);
  }
  return taken;
}

/// Puts contacts into a group, as contacts that have formed, with what its law knows of their history.
template <class Group>
void put_in(Group& group, const std::vector<LooseContact>& contacts, const Model& model) {
  using Kinematics = typename Group::KinematicsType;
  using Law = typename Group::LawType;
  const contact::Placement placement = model.placement();
  for (const LooseContact& loose : contacts) {
    const contact::ContactMotion motion = contact::at_rest(Kinematics::geometry(placement, loose.pair));
    typename Law::State next = group.law.formed(motion.normal);
    contact::take_numbers<Law>(loose.history, next);
    group.pairs.push_back(loose.pair);
    group.states.push_back(next);
  }
}

/// The contacts that are meant, out of all groups: by the kinematics of each.
std::vector<std::pair<std::string_view, std::vector<LooseContact>>> take_all(Model& model,
                                                                             const Choice& choice) {
  std::vector<std::pair<std::string_view, std::vector<LooseContact>>> taken;
  model.contacts.for_each_group([&](auto& group) {
    auto found = take_out(group, model, choice);
    if (!found.empty())
      taken.emplace_back(std::decay_t<decltype(group)>::KinematicsType::name, std::move(found));
  });
  return taken;
}

/// The group of an entry for a kinematics, made if there is none.
AnyGroup& contact_group(Model& model, std::string_view kinematics, std::int32_t rule,
                        const model::Scene& settings) {
  std::vector<AnyGroup>& groups = model.contacts.groups;
  const auto same = [&](const AnyGroup& any) {
    return std::visit(
        [&](const auto& group) {
          return group.rule == rule && std::decay_t<decltype(group)>::KinematicsType::name == kinematics;
        },
        any);
  };
  const auto found = std::find_if(groups.begin(), groups.end(), same);
  if (found != groups.end()) return *found;
  return groups.emplace_back(new_group(kinematics, settings.contacts[static_cast<std::size_t>(rule)], rule));
}

}  // namespace

std::int64_t choose_contacts(State& state, const model::ContactChoice& choice, const std::string& where) {
  const std::int32_t rule = rule_of(state.settings, choice.take, where);
  Model& model = state.model;
  std::int64_t count = 0;
  for (const auto& [kinematics, contacts] : take_all(model, Choice(state, choice, where))) {
    std::visit([&, &loose = contacts](auto& group) { put_in(group, loose, model); },
               contact_group(model, kinematics, rule, state.settings));
    count += std::ssize(contacts);
  }
  if (count == 0)
    throw InputError(fmt::format("{}: no contact that acts is meant; look at where the balls are", where));
  renew_list(state, state.list.skin);
  renew_forces(state);
  forget_step(state);
  state.ledger.reset();
  return count;
}

}  // namespace eigengrain::assembly
