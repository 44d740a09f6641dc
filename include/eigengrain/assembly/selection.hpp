#pragma once

#include "eigengrain/model/bodies.hpp"
#include "eigengrain/model/selection.hpp"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

/// Which bodies are meant.
namespace eigengrain::assembly {

/// Rows of the balls that a selection means, increasing. Throws InputError, beginning with `where`, for
/// a group or a ball that does not exist.
///
/// groups  those that have been made so far
std::vector<std::int32_t> selected(const model::Bodies& bodies, std::span<const model::Group> groups,
                                   const model::Selection& selection, const std::string& where);

/// Makes groups of the balls as they are now; one of a name that exists takes its place. Throws InputError
/// as `selected` does, and where a group would be empty.
///
/// where  the section that they stand in
void make_groups(const model::Bodies& bodies, std::span<const model::GroupChoice> choices,
                 std::vector<model::Group>& groups, const std::string& where = "groups");

}  // namespace eigengrain::assembly
