#pragma once

#include "document.hpp"

#include <span>
#include <string>
#include <string_view>

namespace eigengrain::io {

/// Writes assignments such as "timestep.safety=0.5" or "contacts.0.kn=2e5" into the document, in the order
/// given. What they put there names them as its file.
///
/// origin  where they come from, for messages
void apply_overrides(std::span<const std::string> overrides, std::string_view origin, Document& document,
                     Diagnostics& diagnostics);

}  // namespace eigengrain::io
