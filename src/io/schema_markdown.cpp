#include "eigengrain/contact/law_table.hpp"
#include "eigengrain/io/schema.hpp"

#include "units.hpp"

#include <fmt/format.h>

namespace eigengrain::io {
namespace {

using enum KeyKind;

std::string in_code(std::string_view text) {
  return text.empty() ? std::string() : fmt::format("`{}`", text);
}

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& each : words) text += fmt::format("{}`{}`", text.empty() ? "" : ", ", each);
  return text;
}

std::string value_text(const KeyDescription& key) {
  const std::string unit = key.unit.empty() ? "number" : key.unit;
  const std::string range = key.range.text().empty() ? "" : ", " + key.range.text();
  switch (key.kind) {
    case section:
      return "section";
    case section_list:
      return "list of sections";
    case quantity:
      return unit + range;
    case vector:
      return fmt::format("three of {}", unit);
    case vectors:
      return fmt::format("list of three of {}", unit);
    case quantities:
      return fmt::format("list of {}", unit) + range;
    case integer:
      return "whole number" + range;
    case integers:
      return "list of whole numbers" + range;
    case flag:
      return "`true` or `false`";
    case text:
      return "name";
    case texts:
      return "list of names";
    case word:
      return "one of " + joined(key.words);
    case words:
      return "list out of " + joined(key.words);
  }
  return {};
}

std::string table_row(const KeyDescription& key, std::string_view name) {
  std::string fallback = key.required ? "required" : in_code(key.fallback);
  if (!key.from_materials.empty())
    fallback = fmt::format("{} of the materials, in series{}", key.from_materials,
                           fallback.empty() ? "" : ", or " + fallback);
  return fmt::format("| `{}` | {} | {} | {} | {} |\n", name, value_text(key), fallback, in_code(key.example),
                     key.description);
}

constexpr std::string_view table_head =
    "| key | value | default | example | meaning |\n| --- | --- | --- | --- | --- |\n";

/// Every law with its parameters, those with a default in brackets.
std::string table_of_laws() {
  std::string text = "\n| law | is | parameters |\n| --- | --- | --- |\n";
  for (const contact::LawDescription& law : contact::law_descriptions()) {
    std::string names;
    for (const contact::ParameterDescription& parameter : law.parameters)
      names += fmt::format(fmt::runtime(parameter.default_value ? "{}[`{}`]" : "{}`{}`"),
                           names.empty() ? "" : " ", parameter.name);
    text += fmt::format("| `{}` | {} | {} |\n", law.name, law.description, names);
  }
  return text;
}

/// word  by which a scene asks for one of them; section: where its parameters stand
std::string laws_markdown(std::string_view word, const std::vector<contact::LawDescription>& laws,
                          std::string_view section) {
  std::string text;
  for (const contact::LawDescription& law : laws) {
    text += fmt::format("\n### `{}: {}`\n\n{}\n\n{}", word, law.name, law.description, table_head);
    for (const KeyDescription* key : section_keys(section, law.name))
      if (!key->law.empty()) text += table_row(*key, key->name());
  }
  return text;
}

}  // namespace

std::string schema_markdown() {
  std::string text = R"(# The scene file

Generated from the tables in `src/io/scene_keys_*.cpp` that the reader itself uses; a test keeps the two equal.

A scene is one YAML document. Paths in it are relative to its folder. A key that stands nowhere below is an
error, and so are a wrong unit, a number that is not finite and a key given twice; all mistakes are reported
at once. `--set key=value` on the command line acts as if the file said so: `--set timestep.safety=0.5`,
`--set contacts.0.kn=2e5`, `--set "run={steps: 100}"`.

`[]` stands for each entry of a list. "Required" means: wherever the section itself stands.

## Keys

)";
  text += table_head;
  for (const KeyDescription& key : scene_schema())
    if (key.law.empty() && !key.path.starts_with("stages[].balls[].")) text += table_row(key, key.path);
  text +=
      "\n## Contact laws\n\nThe parameters stand beside `law`, in the same entry of `contacts`; "
      "those in brackets have defaults.\n";
  text += table_of_laws();
  text += laws_markdown("law", contact::law_descriptions(), "contacts[]");
  text +=
      "\n## Bonds\n\nThe parameters stand beside `kind`, in the section `bond` of an entry of `contacts`. "
      "Balls "
      "only are bonded, not walls.\n";
  text += laws_markdown("kind", contact::bond_descriptions(), "contacts[].bond");
  text += "\n## Units\n\n";
  text +=
      "A plain number is in SI units. A quantity may carry its unit instead: `5 mm`, `48 GPa`, `2.5 g/cm3`,\n"
      "`1e5 N/m`, `m s-2`, `kg*m^-3`; a unit of another dimension is an error. µ is the same as u.\n\n";
  return text + units_markdown();
}

}  // namespace eigengrain::io
