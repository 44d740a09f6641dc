#pragma once

#include "eigengrain/base/type_list.hpp"
#include "eigengrain/contact/bonds.hpp"
#include "eigengrain/contact/kinematics.hpp"
#include "eigengrain/contact/laws.hpp"

#include <cstdint>
#include <variant>
#include <vector>

/// Contacts in homogeneous arrays: one kinematics and one law a group, so that a loop over contacts has one
/// dispatch for each group and none for each contact.
namespace eigengrain::contact {

/// Contacts of one kind. pairs[c] and states[c] belong to contact c.
template <class Kinematics, ContactLaw Law>
struct ContactGroup {
  using KinematicsType = Kinematics;
  using LawType = Law;
  using State = typename Law::State;

  Law law;
  std::int32_t rule = 0;  ///< index into Scene::contacts, for reports
  std::vector<Pair> pairs;
  std::vector<State> states;

  std::int64_t size() const { return static_cast<std::int64_t>(pairs.size()); }
};

namespace detail {

template <class... Groups>
struct Variants {
  using type = std::variant<Groups...>;
};
template <class... First, class... Second>
Variants<First..., Second...> operator+(Variants<First...>, Variants<Second...>);

template <class Kinematics, class... Laws>
Variants<ContactGroup<Kinematics, Laws>...> groups_of(TypeList<Laws...>);
template <class... Kinematics>
auto all_groups(TypeList<Kinematics...>)
    -> decltype((groups_of<Kinematics>(LawTypes{}) + ... + groups_of<BallBall>(BondTypes{})));

}  // namespace detail

/// A group of any kind: every kinematics with every law of the table, and every bond between balls.
using AnyGroup = decltype(detail::all_groups(KinematicsTypes{}))::type;

/// All contacts of a model.
struct Contacts {
  std::vector<AnyGroup> groups;

  // Compiled once: each of them is a function for every kinematics with every law, in every file that has a
  // model.
  Contacts();
  Contacts(const Contacts&);
  Contacts(Contacts&&) noexcept;
  Contacts& operator=(const Contacts&);
  Contacts& operator=(Contacts&&) noexcept;
  ~Contacts();

  std::int64_t size() const;

  template <class Visitor>
  void for_each_group(const Visitor& visitor) const {
    for (const AnyGroup& group : groups) std::visit(visitor, group);
  }
  template <class Visitor>
  void for_each_group(const Visitor& visitor) {
    for (AnyGroup& group : groups) std::visit(visitor, group);
  }
};

}  // namespace eigengrain::contact
