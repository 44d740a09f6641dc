#pragma once

#include "eigengrain/assembly/unknowns.hpp"
#include "eigengrain/model/bodies.hpp"

#include "handles.hpp"

namespace eigengrain::petsc {

/// M as an assembled PETSc matrix: diagonal, in the format and layout of StiffnessMatrix. Masked components
/// carry their mass, so that M is never singular.
Matrix mass_matrix(const model::Bodies& bodies, const assembly::Unknowns& unknowns);

}  // namespace eigengrain::petsc
