#pragma once

#include "eigengrain/contact/law.hpp"

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace eigengrain::contact {

/// A law, or a kind of bond, as a user meets it in a scene file.
struct LawDescription {
  std::string_view name;
  std::string_view description;
  std::span<const ParameterDescription> parameters;
  /// What is wrong with values that are each in range, in the order of the parameters; empty: nothing. Null
  /// where any values go together.
  std::string (*mistake)(std::span<const double> values) = nullptr;
};

/// Every law that exists, in the order of the table in law_table.cpp.
const std::vector<LawDescription>& law_descriptions();

/// The law of that name, or nullptr.
const LawDescription* find_law(std::string_view name);

/// The same of the kinds of bonds (bonds.hpp).
const std::vector<LawDescription>& bond_descriptions();
const LawDescription* find_bond(std::string_view name);

}  // namespace eigengrain::contact
