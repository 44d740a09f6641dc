#pragma once

#include "eigengrain/model/scene.hpp"

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace eigengrain::io {

/// Reads and checks a scene file (docs/scene-schema.md). `overrides` are assignments such as
/// "timestep.safety=0.5" or "contacts.0.kn=2e5", in the order given, that act as if the file said so.
///
/// Throws InputError with every mistake found, each with its file and line; a mistake in an override names
/// "--set key=value" instead of a file.
model::Scene read_scene(const std::filesystem::path& file, std::span<const std::string> overrides = {});

/// The same for a text. Paths in it are relative to `folder`; mistakes name the text `name`.
model::Scene read_scene_text(std::string_view yaml, const std::filesystem::path& folder,
                             std::string_view name = "scene", std::span<const std::string> overrides = {});

/// The balls that a stage adds, as read from the document of the settings; seeds grow by the repetition.
/// Throws InputError where files are gone or balls find no place.
model::Bodies read_added_balls(const model::Scene& settings, std::int64_t stage, std::int64_t repetition);

/// Regions of the command line, each the keys of an entry of `measures`, such as "box: {min: [0, 0, 0], max:
/// [1, 1, 1]}". Throws InputError with every mistake, which names "--region" and the text.
std::vector<model::Region> read_regions(std::span<const std::string> entries);

}  // namespace eigengrain::io
