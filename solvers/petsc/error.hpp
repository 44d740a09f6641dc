#pragma once

#include <petscsys.h>

namespace eigengrain::petsc {

/// The one place where PETSc's error codes become exceptions: throws SolverError with the name of the call
/// and PETSc's own description.
void check(PetscErrorCode code, const char* call);

}  // namespace eigengrain::petsc

/// Runs a PETSc or SLEPc call and throws if it fails.
#define EIGENGRAIN_PETSC(call) ::eigengrain::petsc::check((call), #call)
