#include "restore_contacts.hpp"

#include "eigengrain/assembly/bonds.hpp"
#include "eigengrain/assembly/contact_list.hpp"
#include "eigengrain/base/error.hpp"
#include "eigengrain/contact/bonds.hpp"
#include "eigengrain/contact/law_table.hpp"
#include "eigengrain/contact/state_numbers.hpp"

#include "state_layout.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <iterator>
#include <span>
#include <sstream>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace eigengrain::io {
namespace {

using contact::Pair;

std::vector<std::string> words_of(const std::string& text) {
  std::istringstream stream(text);
  return {std::istream_iterator<std::string>(stream), {}};
}

/// Reads one group.
class GroupReader {
 public:
  GroupReader(const h5::File& file, std::string path, const model::Scene& settings,
              const assembly::Model& model, const std::string& name)
      : file_(file), path_(std::move(path)), settings_(settings), model_(model), name_(name) {}

  contact::AnyGroup read() const {
    const std::int64_t rule = file_.integer(path_, "rule");
    const std::string law = file_.text(path_, "law");
    const auto rules = static_cast<std::int64_t>(settings_.contacts.size());
    if (rule < 0 || rule >= rules)
      refuse(
          fmt::format("the state has contacts of contacts[{}], and only {} entries are left; keep those "
                      "that are in use",
                      rule, rules));
    const model::ContactRule& now = settings_.contacts[static_cast<std::size_t>(rule)];
    const bool bonds = contact::find_bond(law) != nullptr;
    if (!bonds && now.law != law)
      refuse(
          fmt::format("contacts[{}]: law {}; the state has contacts with the law {} there, whose history "
                      "another law cannot continue",
                      rule, now.law, law));
    if (bonds && (!now.bond || now.bond->kind != law))
      damaged(fmt::format("{} bonds of contacts[{}], whose settings have none", law, rule));
    const auto index = static_cast<std::int32_t>(rule);
    contact::AnyGroup group = bonds ? assembly::new_bond_group(now, index)
                                    : assembly::new_group(file_.text(path_, "kinematics"), now, index);
    std::visit([&](auto& concrete) { fill(concrete); }, group);
    return group;
  }

 private:
  [[noreturn]] void refuse(std::string message) const { throw InputError({{name_, 0, std::move(message)}}); }
  [[noreturn]] void damaged(std::string_view what) const {
    throw h5::Error(fmt::format("{}: {}", path_, what));
  }

  template <class Group>
  void fill(Group& group) const {
    group.pairs = read_pairs();
    if constexpr (std::is_same_v<typename Group::KinematicsType, contact::BallFacet>) {
      const auto side = file_.read<std::int8_t>(path_ + "/side", group.pairs.size());
      for (std::size_t c = 0; c < side.size(); ++c) group.pairs[c].side = side[c];
    }
    check_pairs<typename Group::KinematicsType>(group.pairs);
    check_rules<typename Group::KinematicsType>(group);
    using Law = typename Group::LawType;
    const std::string stored = file_.text(path_, "state_fields");
    if constexpr (contact::in_total_form<Law>)
      if (model_.bodies.orientation.empty()) damaged("bonds, but balls without orientation");
    if constexpr (contact::BondLaw<Law>)
      if (Law::additive && stored != layout::state_fields<Law>())
        refuse(fmt::format(
            "contacts[{}].bond: another form than that of the bonds of the state; keep `incremental` "
            "as it was",
            settings_.contacts[static_cast<std::size_t>(group.rule)].entry));
    form_states(group);
    read_states(group, words_of(stored));
  }

  std::vector<Pair> read_pairs() const {
    const std::size_t count = file_.rows(path_ + "/a");
    const auto first = file_.read<std::int32_t>(path_ + "/a", count);
    const auto second = file_.read<std::int32_t>(path_ + "/b", count);
    const auto image = file_.read<model::Image>(path_ + "/image", count);
    std::vector<Pair> pairs(count);
    for (std::size_t c = 0; c < count; ++c) pairs[c] = {first[c], second[c], image[c]};
    return pairs;
  }

  template <class Kinematics>
  void check_pairs(const std::vector<Pair>& pairs) const {
    const std::int32_t bodies = model_.bodies.size();
    const std::int32_t sides = count_of_seconds<Kinematics>();
    for (const Pair& pair : pairs) {
      if (pair.a < 0 || pair.a >= bodies || pair.b < 0 || pair.b >= sides)
        damaged(fmt::format("a contact of {} and {}, but there are {} balls and {} of the other side", pair.a,
                            pair.b, bodies, sides));
      if (Kinematics::second_is_body && pair.a == pair.b && pair.image == model::Image{})
        damaged(fmt::format("a contact of ball {} with itself", pair.a));
      for (std::size_t k = 0; k < 3; ++k)
        if (pair.image[k] != 0 && !model_.cell.periodic[k])
          damaged("a contact through the periodic cell along an axis that does not repeat");
    }
  }

  template <class Kinematics>
  std::int32_t count_of_seconds() const {
    if constexpr (Kinematics::second_is_body)
      return model_.bodies.size();
    else if constexpr (std::is_same_v<Kinematics, contact::BallFacet>)
      return model_.facets.size();
    else
      return static_cast<std::int32_t>(model_.walls.size());
  }

  template <class Kinematics>
  std::int32_t second_material(const Pair& pair) const {
    if constexpr (Kinematics::second_is_body)
      return model_.bodies.material[static_cast<std::size_t>(pair.b)];
    else
      return model_.wall_material(Kinematics::wall(model_.placement(), pair));
  }

  /// The entry of `contacts` that holds for each pair now has to be the one that held for it.
  template <class Kinematics, class Group>
  void check_rules(const Group& group) const {
    if (settings_.contacts[static_cast<std::size_t>(group.rule)].by_choice()) return;
    const std::vector<std::int32_t>& material = model_.bodies.material;
    const std::size_t materials = settings_.materials.size();
    std::vector<bool> known(materials * materials);
    for (const Pair& pair : group.pairs) {
      const std::int32_t a = material[static_cast<std::size_t>(pair.a)];
      const std::int32_t b = second_material<Kinematics>(pair);
      const std::size_t at = static_cast<std::size_t>(a) * materials + static_cast<std::size_t>(b);
      if (known[at]) continue;
      known[at] = true;
      const std::int32_t rule = settings_.rule_for(a, b);
      if (rule != group.rule)
        refuse(
            fmt::format("contacts[{}] holds for {} and {} now, and contacts[{}] did when the state was "
                        "written; keep the entries of contacts and their order",
                        rule, settings_.materials[static_cast<std::size_t>(a)].name,
                        settings_.materials[static_cast<std::size_t>(b)].name, group.rule));
    }
  }

  /// The parts of the history that the file has (`stored`, by name); a part of the law that has come on
  /// since, such as a dashpot, keeps what it starts with.
  template <class Group>
  void read_states(Group& group, const std::vector<std::string>& stored) const {
    if constexpr (!std::is_empty_v<typename Group::State>)
      contact::for_each_field<typename Group::LawType>(
          [&](const contact::StateField& field, std::size_t offset) {
            if (std::find(stored.begin(), stored.end(), field.name) == stored.end()) return;
            const auto components = static_cast<std::size_t>(field.components);
            const std::vector<double> values = file_.read_doubles(fmt::format("{}/{}", path_, field.name),
                                                                  group.states.size(), field.components);
            for (std::size_t c = 0; c < group.states.size(); ++c) {
              const auto bytes = std::as_writable_bytes(std::span(&group.states[c], 1));
              std::memcpy(&bytes[offset], &values[components * c], components * sizeof(double));
            }
          });
  }

  /// As assembly::list_contacts does it for a contact that is new.
  template <class Group>
  void form_states(Group& group) const {
    using State = typename Group::State;
    const contact::Placement placement = model_.placement();
    for (const Pair& pair : group.pairs) {
      const contact::ContactMotion motion =
          contact::at_rest(Group::KinematicsType::geometry(placement, pair));
      group.states.push_back(group.law.acts(motion, State{}) ? group.law.formed(motion.normal) : State{});
    }
  }

  const h5::File& file_;
  std::string path_;
  const model::Scene& settings_;
  const assembly::Model& model_;
  const std::string& name_;
};

}  // namespace

contact::Contacts restore_contacts(const h5::File& file, const model::Scene& settings,
                                   const assembly::Model& model, const std::string& name) {
  contact::Contacts contacts;
  const std::int64_t groups = file.integer(layout::contacts, "groups");
  for (std::int64_t k = 0; k < groups; ++k)
    contacts.groups.push_back(GroupReader(file, layout::group(k), settings, model, name).read());
  return contacts;
}

}  // namespace eigengrain::io
