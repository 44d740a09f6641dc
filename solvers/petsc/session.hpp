#pragma once

#include <petscsys.h>

#include <string>

namespace eigengrain::petsc {

/// Starts PETSc, SLEPc and MPI at the first call, unless the host program (a Python session, say) already
/// has; what was started here is finished when the program ends. Runs that ask nothing of PETSc never come
/// here. BLAS is held to one thread: with more, it gives other bits on another number of threads.
void start();

/// Options as on PETSc's command line, for everything that is created from now on, e.g. "-eps_ncv 80".
/// Throws InputError for text that PETSc cannot read.
void set_options(const std::string& options);

/// The one place where PETSc's error codes become exceptions: throws SolverError with the name of the call
/// and PETSc's own description.
void check(PetscErrorCode code, const char* call);

}  // namespace eigengrain::petsc

/// Runs a PETSc or SLEPc call and throws if it fails.
#define EIGENGRAIN_PETSC(call) ::eigengrain::petsc::check((call), #call)
