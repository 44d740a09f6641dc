#pragma once

#include "eigengrain/base/text.hpp"
#include "eigengrain/model/scene.hpp"

#include <nlohmann/json_fwd.hpp>

#include <cstdint>
#include <string>

namespace eigengrain::app {

/// "1 body", "10,000 bodies".
std::string counted(std::int64_t number, const std::string& one, const std::string& many);

/// Prints what the reader found odd in the scene.
void print_notes(const model::Scene& scene);

/// Writes the document to the file, or nothing where the name is empty. Throws InputError if it cannot.
void write_json(const std::string& file, const nlohmann::ordered_json& document);

}  // namespace eigengrain::app
