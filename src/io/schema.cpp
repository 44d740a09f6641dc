#include "eigengrain/io/schema.hpp"

#include "eigengrain/contact/law_table.hpp"

#include "scene_keys.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace eigengrain::io {
namespace {

using enum KeyKind;

constexpr double infinity = std::numeric_limits<double>::infinity();

/// section  that the parameter stands in: of a contact or of its bond
KeyDescription law_key(std::string_view section, const contact::LawDescription& law,
                       const contact::ParameterDescription& parameter) {
  const bool is_flag = parameter.kind == contact::ParameterDescription::Kind::flag;
  KeyDescription key{.path = fmt::format("{}.{}", section, parameter.name),
                     .kind = is_flag ? flag : quantity};
  key.law = law.name;
  key.unit = parameter.unit;
  key.description = parameter.description;
  key.from_materials = parameter.of_material != nullptr ? parameter.material_keys : "";
  key.required = !parameter.default_value.has_value() && parameter.of_material == nullptr;
  if (is_flag) {
    if (!key.required) key.fallback = *parameter.default_value != 0 ? "true" : "false";
    key.example = "true";
    return key;
  }
  key.range = {.low = parameter.minimum, .high = parameter.maximum, .low_allowed = parameter.minimum_allowed};
  // A default without bound is that of a key that is left out; no number says it.
  if (parameter.default_value && *parameter.default_value < infinity)
    key.fallback = fmt::format("{}", *parameter.default_value);
  const double valid = parameter.minimum > -infinity ? parameter.minimum + 1 : 1;
  key.example = key.unit.empty() ? fmt::format("{}", valid) : fmt::format("{} {}", valid, key.unit);
  return key;
}

/// A section's keys stand together, those of the laws behind the others of `contacts`.
std::vector<KeyDescription> all_keys() {
  std::vector<KeyDescription> keys = contact_keys();
  for (const contact::LawDescription& law : contact::law_descriptions())
    for (const contact::ParameterDescription& parameter : law.parameters)
      keys.push_back(law_key("contacts[]", law, parameter));
  for (const contact::LawDescription& bond : contact::bond_descriptions())
    for (const contact::ParameterDescription& parameter : bond.parameters)
      keys.push_back(law_key("contacts[].bond", bond, parameter));
  for (const auto& more :
       {ball_keys(), clump_keys(), deformable_keys(), wall_keys(), run_keys(), stage_keys(), output_keys()})
    keys.insert(keys.end(), more.begin(), more.end());
  return keys;
}

}  // namespace

bool Range::contains(double value) const {
  const bool above = low_allowed ? value >= low : value > low;
  const bool below = high_allowed ? value <= high : value < high;
  return above && below;
}

std::string Range::text() const {
  const std::string above = low > -infinity ? fmt::format("{} {}", low_allowed ? ">=" : ">", low) : "";
  const std::string below = high < infinity ? fmt::format("{} {}", high_allowed ? "<=" : "<", high) : "";
  return above.empty() || below.empty() ? above + below : above + " and " + below;
}

std::string_view KeyDescription::name() const {
  const std::string_view all = path;
  return all.substr(all.rfind('.') + 1);
}

std::string_view KeyDescription::section() const {
  const std::size_t dot = path.rfind('.');
  return dot == std::string::npos ? std::string_view() : std::string_view(path).substr(0, dot);
}

std::vector<std::string> law_names() {
  std::vector<std::string> names;
  for (const contact::LawDescription& law : contact::law_descriptions()) names.emplace_back(law.name);
  names.emplace_back("none");
  return names;
}

std::vector<std::string> bond_names() {
  std::vector<std::string> names;
  for (const contact::LawDescription& bond : contact::bond_descriptions()) names.emplace_back(bond.name);
  return names;
}

const std::vector<KeyDescription>& scene_schema() {
  static const std::vector<KeyDescription> keys = all_keys();
  return keys;
}

std::vector<const KeyDescription*> section_keys(std::string_view section, std::string_view law) {
  std::vector<const KeyDescription*> keys;
  for (const KeyDescription& key : scene_schema())
    if (key.section() == section && (law.empty() || key.law.empty() || key.law == law)) keys.push_back(&key);
  return keys;
}

}  // namespace eigengrain::io
