#pragma once

#include "eigengrain/assembly/linear_system.hpp"
#include "eigengrain/assembly/stiffness_parts.hpp"

#include <cstdint>
#include <vector>

namespace eigengrain::assembly {

/// K [unknowns × unknowns], both triangles, N/m, N, N m; masked rows and columns are zero. To the bit
/// symmetric. Cost O(contacts).
BlockMatrix stiffness_blocks(const LinearSystem& system);

/// B [6 elements × unknowns]: rows of element e are its relative displacement δ (m) and rotation φ (rad),
/// docs/theory.md. Columns of masked components are zero, those of clumps along their axes: K = BᵀDB.
BlockMatrix kinematic_blocks(const LinearSystem& system);

/// D [6 elements × 6 elements], block diagonal: translation (N/m) and rotation (N m) of each element.
BlockMatrix elasticity_blocks(const LinearSystem& system);

}  // namespace eigengrain::assembly
