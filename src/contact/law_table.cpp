#include "eigengrain/contact/law_table.hpp"

#include "eigengrain/contact/bonds.hpp"
#include "eigengrain/contact/laws.hpp"

#include <algorithm>

namespace eigengrain::contact {
namespace {

template <class Law>
void add_description(std::vector<LawDescription>& table) {
  static_assert(ContactLaw<Law>);
  const auto same_name = [](const LawDescription& entry) { return entry.name == Law::name; };
  if (std::none_of(table.begin(), table.end(), same_name))
    table.push_back({Law::name, Law::description, Law::parameters});
  // Of the classes of a name those come last that use all parameters, and know what goes together.
  if constexpr (requires { &Law::mistake; }) table.back().mistake = &Law::mistake;
}

template <class Types>
std::vector<LawDescription> describe() {
  std::vector<LawDescription> table;
  for_each_type(Types{}, [&](auto law) { add_description<typename decltype(law)::type>(table); });
  return table;
}

const LawDescription* find(const std::vector<LawDescription>& table, std::string_view name) {
  const auto found = std::find_if(table.begin(), table.end(),
                                  [&](const LawDescription& entry) { return entry.name == name; });
  return found == table.end() ? nullptr : &*found;
}

}  // namespace

const std::vector<LawDescription>& law_descriptions() {
  static const std::vector<LawDescription> table = describe<LawTypes>();
  return table;
}

const LawDescription* find_law(std::string_view name) {
  return find(law_descriptions(), name);
}

const std::vector<LawDescription>& bond_descriptions() {
  static const std::vector<LawDescription> table = describe<BondTypes>();
  return table;
}

const LawDescription* find_bond(std::string_view name) {
  return find(bond_descriptions(), name);
}

}  // namespace eigengrain::contact
