#pragma once

#include "eigengrain/assembly/model.hpp"

namespace eigengrain::assembly {

/// Moves the centres into the cell, whose edges are made short before, and the images of the contacts with
/// them. A clump moves as a whole, with its own centre; balls of it may then lie beyond the cell.
void wrap(Model& model);

}  // namespace eigengrain::assembly
