#pragma once

#include "eigengrain/model/selection.hpp"

#include "scene_draft.hpp"
#include "section.hpp"

#include <optional>
#include <string>

namespace eigengrain::io {

/// The shape of a region, which the keys of a section say; none if something is wrong with it, which has been
/// reported.
std::optional<decltype(model::Region::shape)> read_shape(const Section& section);

/// The keys of a selection, `group` excepted; whether there is such a ball is not looked at.
model::Selection read_selection(const Section& section, const SceneDraft& draft);

/// Reports a wall that the scene has not, at the key `wall`. After read_walls.
void check_wall_name(const Section& section, const std::string& wall, const SceneDraft& draft);

}  // namespace eigengrain::io
