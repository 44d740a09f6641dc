#pragma once

#include "eigengrain/model/scene.hpp"

#include <filesystem>
#include <span>
#include <string>
#include <string_view>

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

}  // namespace eigengrain::io
