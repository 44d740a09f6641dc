#pragma once

#include "eigengrain/assembly/linear_system.hpp"

#include "handles.hpp"

namespace eigengrain::petsc {

/// M as an assembled PETSc matrix: diagonal, in the format and layout of StiffnessMatrix. Masked components
/// carry their mass, so that M is never singular.
Matrix mass_matrix(const assembly::LinearSystem& system);

}  // namespace eigengrain::petsc
