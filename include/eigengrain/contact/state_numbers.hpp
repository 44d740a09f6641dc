#pragma once

#include "eigengrain/contact/law.hpp"

#include <array>
#include <cstddef>
#include <cstring>
#include <span>
#include <string_view>
#include <type_traits>
#include <vector>

/// The state of a contact as named numbers, for those who carry it to a file or to another law.
namespace eigengrain::contact {

/// Calls visit(field, offset in bytes) for each part of the state of a law.
template <class Law, class Visit>
void for_each_field(const Visit& visit) {
  std::size_t offset = 0;
  for (const StateField& field : Law::state_fields) {
    visit(field, offset);
    offset += static_cast<std::size_t>(field.components) * sizeof(double);
  }
}

/// A part of a state: its name and up to four numbers.
struct NamedNumbers {
  std::string_view name;
  std::array<double, 4> value{};
};

template <class Law>
std::vector<NamedNumbers> numbers_of(const typename Law::State& state) {
  std::vector<NamedNumbers> result;
  if constexpr (!std::is_empty_v<typename Law::State>)
    for_each_field<Law>([&](const StateField& field, std::size_t offset) {
      NamedNumbers& part = result.emplace_back(NamedNumbers{field.name});
      const auto bytes = std::as_bytes(std::span(&state, 1));
      std::memcpy(part.value.data(), &bytes[offset],
                  static_cast<std::size_t>(field.components) * sizeof(double));
    });
  return result;
}

/// Puts the numbers into the parts of the same name.
template <class Law>
void take_numbers(std::span<const NamedNumbers> numbers, typename Law::State& state) {
  if constexpr (!std::is_empty_v<typename Law::State>)
    for_each_field<Law>([&](const StateField& field, std::size_t offset) {
      for (const NamedNumbers& part : numbers)
        if (part.name == field.name) {
          const auto bytes = std::as_writable_bytes(std::span(&state, 1));
          std::memcpy(&bytes[offset], part.value.data(),
                      static_cast<std::size_t>(field.components) * sizeof(double));
        }
    });
}

}  // namespace eigengrain::contact
