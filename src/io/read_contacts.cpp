#include "eigengrain/contact/bonds.hpp"
#include "eigengrain/contact/law_table.hpp"
#include "eigengrain/io/suggest.hpp"

#include "scene_draft.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace eigengrain::io {
namespace {

using model::ContactRule;

/// Index of a material, any_material for "any", or nothing after a report.
std::optional<std::int32_t> read_side(const Section& section, const std::string& name,
                                      const model::Scene& scene) {
  if (name == "any") return ContactRule::any_material;
  std::vector<std::string> names{"any"};
  for (std::size_t k = 0; k < scene.materials.size(); ++k) {
    if (scene.materials[k].name == name) return static_cast<std::int32_t>(k);
    names.push_back(scene.materials[k].name);
  }
  section.report("between", fmt::format("unknown material \"{}\"{}", name, did_you_mean(name, names)));
  return std::nullopt;
}

bool read_between(const Section& section, const model::Scene& scene, ContactRule& rule) {
  if (!section.has("between")) {
    if (section.has("name")) return true;  // for contacts that exist, of any materials
    section.report_missing("between");
    return false;
  }
  const auto names = section.texts("between");
  if (!names) return false;
  if (names->size() != 2) {
    section.report("between",
                   fmt::format("{} names; two are wanted, e.g. \"between: [any, any]\"", names->size()));
    return false;
  }
  const auto first = read_side(section, names->front(), scene);
  const auto second = read_side(section, names->back(), scene);
  rule.first = first.value_or(-1);
  rule.second = second.value_or(-1);
  return first && second;
}

/// The value of one parameter, flags as 0 or 1. A missing one has been reported by check_keys.
std::optional<double> read_parameter(const Section& section, const contact::ParameterDescription& parameter) {
  if (parameter.kind == contact::ParameterDescription::Kind::quantity)
    return section.quantity(parameter.name);
  const auto flag = section.flag(parameter.name);
  return flag ? std::optional(*flag ? 1.0 : 0.0) : std::nullopt;
}

/// Whether the entry leaves a parameter to the materials: one without default always, and one with a default
/// where some material says something.
bool leaves_to_materials(const Section& section, const contact::ParameterDescription& parameter,
                         const model::Scene& scene) {
  if (parameter.of_material == nullptr || section.has(parameter.name)) return false;
  return !parameter.default_value ||
         std::any_of(scene.materials.begin(), scene.materials.end(),
                     [&](const model::Material& m) { return parameter.of_material(m).has_value(); });
}

void read_law(const Section& any_law, const model::Scene& scene, ContactRule& rule) {
  const auto name = any_law.text("law");
  if (!name) return any_law.check_keys();
  const Section section = any_law.with_law(*name);
  section.check_keys();
  rule.law = *name;
  const contact::LawDescription* law = contact::find_law(*name);
  if (law == nullptr) return;  // "none"
  const std::int64_t mistakes_before = section.diagnostics().count();
  for (const contact::ParameterDescription& parameter : law->parameters) {
    if (leaves_to_materials(section, parameter, scene))
      rule.parameters.push_back(left_to_materials);
    else
      rule.parameters.push_back(read_parameter(section, parameter).value_or(0));
  }
  if (law->mistake == nullptr || section.diagnostics().count() > mistakes_before) return;
  if (const std::string mistake = law->mistake(rule.parameters); !mistake.empty()) section.report(mistake);
}

/// A bond that is a part of the law fits the linear law only, and not the springs that never open.
void check_contact_bond(const Section& contact, const ContactRule& rule) {
  if (rule.bond->kind != contact::ContactBond::name || rule.law.empty()) return;
  if (rule.law != contact::Linear::name)
    contact.report("bond",
                   fmt::format("a {} bond is one of the law {}, not of {}; write \"law: {}\", or \"kind: "
                               "parallel\"",
                               rule.bond->kind, contact::Linear::name, rule.law, contact::Linear::name));
  else if (contact::LinearSprings::params(rule.parameters).tension)
    contact.report("tension",
                   "springs with tension never open, so a contact bond means nothing there; leave "
                   "out one of the two");
  else if (!contact::DampedLinear::serves(rule.parameters))
    contact.report("bond",
                   "a contact bond carries no moment, so it knows no rolling resistance; leave out `kr` and "
                   "`rolling_friction`, or write \"kind: parallel\"");
}

void read_bond(const Section& contact, ContactRule& rule) {
  if (!contact.has("bond")) return;
  const auto any_kind = contact.section("bond");
  if (!any_kind) return;
  const auto kind = any_kind->text("kind");
  if (!kind) return any_kind->check_keys();
  const Section section = any_kind->with_law(*kind);
  section.check_keys();
  model::BondRule bond{.kind = *kind, .parameters = {}, .gap = section.quantity("gap").value_or(0)};
  for (const contact::ParameterDescription& parameter : contact::find_bond(*kind)->parameters)
    bond.parameters.push_back(
        read_parameter(section, parameter).value_or(parameter.default_value.value_or(0)));
  rule.bond = std::move(bond);
  check_contact_bond(contact, rule);
}

/// An entry with a name is for contacts that exist already, of any materials.
void read_name(const Section& section, const std::vector<ContactRule>& rules, ContactRule& rule) {
  if (!section.has("name")) return;
  const auto name = section.text("name");
  if (!name) return;
  rule.name = *name;
  if (std::any_of(rules.begin(), rules.end(), [&](const ContactRule& other) { return other.name == *name; }))
    section.report("name", fmt::format("\"{}\" is the name of another entry; choose another one", *name));
  if (rule.law == "none")
    section.report("law", "none beside a name: contacts that exist need a law; write e.g. \"law: linear\"");
  if (rule.bond)
    section.report("bond", "beside a name: bonds are made when the scene starts; leave out one of the two");
  if (std::any_of(rule.parameters.begin(), rule.parameters.end(), [](double p) { return std::isnan(p); }))
    section.report("name",
                   "beside parameters that are left to the materials, which differ from contact to "
                   "contact; give all of them here");
}

/// Whether the rule matches every pair that the other one does ("any" is matched by "any" only).
bool covers(const ContactRule& rule, const ContactRule& other) {
  return rule.matches(other.first, other.second);
}

}  // namespace

void read_contacts(const Section& root, SceneDraft& draft) {
  std::vector<ContactRule>& rules = draft.scene.contacts;
  std::vector<std::string> paths;
  const std::int64_t mistakes_before = root.diagnostics().count();
  const std::vector<Section> sections = root.sections("contacts");
  draft.contacts_complete = root.diagnostics().count() == mistakes_before;
  for (const Section& section : sections) {
    ContactRule rule;
    rule.entry = static_cast<std::int32_t>(&section - sections.data());
    const bool known_pair = read_between(section, draft.scene, rule);
    draft.contacts_complete = draft.contacts_complete && known_pair;
    read_law(section, draft.scene, rule);
    read_bond(section, rule);
    read_name(section, rules, rule);
    if (!known_pair) continue;
    // A pair whose law has mistakes still counts as one that has a law: one report is enough.
    const auto earlier =
        std::find_if(rules.begin(), rules.end(), [&](const auto& r) { return covers(r, rule); });
    if (earlier != rules.end() && !rule.by_choice())
      section.report(
          "between",
          fmt::format("never used: {} matches all of its pairs, and the first holds; remove one, or put "
                      "the special entry first",
                      paths[static_cast<std::size_t>(earlier - rules.begin())]));
    rules.push_back(std::move(rule));
    draft.contact_places.push_back(section.place());
    paths.push_back(fmt::format("{} (line {})", section.path(), section.place().line));
  }
  draft.scene.full_levers = root.text("levers") == "surface";
  if (draft.scene.full_levers &&
      std::any_of(rules.begin(), rules.end(), [](const ContactRule& rule) { return rule.bond.has_value(); }))
    root.report("levers", "surface beside bonds, which hold at the contact point; leave the key out");
}

}  // namespace eigengrain::io
