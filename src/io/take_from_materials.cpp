#include "eigengrain/contact/law_table.hpp"

#include "scene_draft.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>

namespace eigengrain::io {
namespace {

using model::ContactRule;
using model::Material;

bool is_open(const ContactRule& rule) {
  return std::any_of(rule.parameters.begin(), rule.parameters.end(), [](double p) { return std::isnan(p); });
}

/// Two sides in series; a rigid one (infinite) leaves the other. Nothing if a side says nothing or both are
/// rigid.
std::optional<double> in_series(std::optional<double> a, std::optional<double> b) {
  if (!a || !b || (std::isinf(*a) && std::isinf(*b))) return std::nullopt;
  if (std::isinf(*a)) return b;
  if (std::isinf(*b)) return a;
  return *a + *b > 0 ? *a * *b / (*a + *b) : 0.0;
}

/// Why a parameter that an entry leaves to the materials is not found there.
std::string problem(const ContactRule& rule, const contact::ParameterDescription& parameter,
                    const std::set<std::string>& silent) {
  if (silent.empty())
    return fmt::format(
        "contacts[{0}]: {1} is left to the materials, and two rigid ones can meet; give {1} here, "
        "or take `rigid` from one of them",
        rule.entry, parameter.name);
  return fmt::format("contacts[{}]: {} is missing; add e.g. \"{}: 1 {}\", or give {} to {}", rule.entry,
                     parameter.name, parameter.name, parameter.unit, parameter.material_keys,
                     fmt::join(silent, " and "));
}

}  // namespace

void take_from_materials(SceneDraft& draft, Diagnostics& diagnostics) {
  model::Scene& scene = draft.scene;
  if (std::none_of(scene.contacts.begin(), scene.contacts.end(), is_open)) return;
  const auto pairs = meeting_pairs(draft);
  std::vector<ContactRule> rules;
  for (std::size_t r = 0; r < scene.contacts.size(); ++r) {
    const ContactRule& rule = scene.contacts[r];
    if (!is_open(rule)) {
      rules.push_back(rule);
      continue;
    }
    const auto parameters = contact::find_law(rule.law)->parameters;
    const std::size_t first = rules.size();
    for (const auto& [a, b] : pairs) {
      if (scene.rule_for(a, b) != static_cast<std::int32_t>(r)) continue;
      ContactRule& of_pair = rules.emplace_back(rule);
      of_pair.first = a;
      of_pair.second = b;
    }
    for (std::size_t p = 0; p < parameters.size(); ++p) {
      if (!std::isnan(rule.parameters[p])) continue;
      bool missing = false;
      std::set<std::string> silent;
      for (std::size_t k = first; k < rules.size(); ++k) {
        const Material& a = scene.materials[rules[k].first];
        const Material& b = scene.materials[rules[k].second];
        const auto of_a = parameters[p].of_material(a);
        const auto of_b = parameters[p].of_material(b);
        const auto found = in_series(of_a, of_b);
        rules[k].parameters[p] = found.value_or(parameters[p].default_value.value_or(0));
        if (found || parameters[p].default_value) continue;
        missing = true;
        if (!of_a) silent.insert(fmt::format("the material \"{}\"", a.name));
        if (!of_b) silent.insert(fmt::format("the material \"{}\"", b.name));
      }
      if (missing) diagnostics.add(draft.contact_places[r], problem(rule, parameters[p], silent));
    }
  }
  scene.contacts = std::move(rules);
}

}  // namespace eigengrain::io
