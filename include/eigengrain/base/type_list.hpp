#pragma once

namespace eigengrain {

/// A list of types as a value, for tables that are fixed when the program is compiled.
template <class... Types>
struct TypeList {};

/// One type as a value.
template <class T>
struct TypeTag {
  using type = T;
};

/// Calls visit(TypeTag<T>{}) for every type of the list, in order.
template <class... Types, class Visit>
constexpr void for_each_type(TypeList<Types...> /*list*/, const Visit& visit) {
  (visit(TypeTag<Types>{}), ...);
}

}  // namespace eigengrain
