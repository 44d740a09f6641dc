#pragma once

#include "eigengrain/model/scene.hpp"

#include <optional>
#include <string>

namespace eigengrain::io {

/// What is wrong with new settings for a state that was started with `stored`: they may not pull away what
/// its numbers rest upon.
std::optional<std::string> forbidden_change(const model::Scene& stored, const model::Scene& now);

/// Whether contacts may be elsewhere than where the neighbour list looked for them.
bool surroundings_moved(const model::Scene& stored, const model::Scene& now);

/// Whether pairs may have a law that had none: those are not in the list.
bool pairs_may_be_new(const model::Scene& stored, const model::Scene& now);

}  // namespace eigengrain::io
