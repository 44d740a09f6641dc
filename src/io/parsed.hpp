#pragma once

#include <optional>
#include <string>

namespace eigengrain::io {

/// What a text says, or what is wrong with it and what to write instead.
template <class T>
struct Parsed {
  std::optional<T> value{};
  std::string problem{};  ///< empty exactly where there is a value
};

}  // namespace eigengrain::io
