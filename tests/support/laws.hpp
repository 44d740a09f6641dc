#pragma once

#include "eigengrain/contact/law_table.hpp"

#include "support/scenes.hpp"

#include <initializer_list>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

/// Parameters of contact laws by name.
namespace eigengrain::test {

using Named = std::initializer_list<std::pair<std::string_view, double>>;

/// Values of all parameters of a law: those named, and the defaults of the others.
inline std::vector<double> values_of(std::string_view law, Named named) {
  const contact::LawDescription* description = contact::find_law(law);
  if (description == nullptr) throw std::invalid_argument("no law " + std::string(law));
  std::vector<double> values;
  for (const contact::ParameterDescription& p : description->parameters)
    values.push_back(p.default_value.value_or(0));
  for (const auto& [name, value] : named) {
    std::size_t k = 0;
    while (k < values.size() && description->parameters[k].name != name) ++k;
    values.at(k) = value;
  }
  return values;
}

/// A scene of one material whose contacts have this law.
inline SceneBuilder with_law(std::string_view law, Named named) {
  SceneBuilder builder;
  builder.scene().contacts = {{.law = std::string(law), .parameters = values_of(law, named)}};
  return builder;
}

}  // namespace eigengrain::test
