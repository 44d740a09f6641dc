#pragma once

#include <span>
#include <string>
#include <string_view>

namespace eigengrain::io {

/// Cost of turning one word into the other: 2 for each letter inserted, left out or replaced and for each
/// swap of neighbours, 1 for each letter whose case alone differs.
int spelling_distance(std::string_view a, std::string_view b);

/// The candidate that the user most likely meant, or empty if none is near. Ties go to the first.
std::string_view nearest_name(std::string_view word, std::span<const std::string> candidates);

/// `; did you mean "friction"?`, or empty if no candidate is near.
std::string did_you_mean(std::string_view word, std::span<const std::string> candidates);

}  // namespace eigengrain::io
