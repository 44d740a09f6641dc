#pragma once

#include "eigengrain/model/scene.hpp"

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

namespace eigengrain::io {

/// Reads and checks a scene without its balls, as Scene::document has it, for balls that exist already and
/// are where they are: neither the document nor the overrides may name balls, and where they lie is not
/// checked. The scene has no bodies.
///
/// material_of_ball  [balls] index into the scene's materials; one out of range is a mistake
/// origin            of the overrides, for messages
model::Scene read_settings_text(std::string_view document, const std::filesystem::path& folder,
                                std::string_view name, std::span<const std::string> overrides,
                                std::span<const std::int32_t> material_of_ball,
                                std::string_view origin = "--set");

}  // namespace eigengrain::io
