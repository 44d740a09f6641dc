#pragma once

#include <string>

/// The life of PETSc in this program. This header includes nothing of PETSc's.
namespace eigengrain::petsc {

/// Starts PETSc, SLEPc and MPI at the first call, unless the host program (a Python session, say) already
/// has; what was started here is finished when the program ends. Runs that ask nothing of PETSc never come
/// here. BLAS is held to one thread: with more, it gives other bits on another number of threads.
void start();

/// Options as on PETSc's command line, for everything that is created from now on, e.g. "-eps_ncv 80".
/// Throws InputError for text that is no list of options.
void set_options(const std::string& options);

/// Throws InputError that names options of set_options that nothing has asked for so far: misspelt ones.
void require_options_used();

}  // namespace eigengrain::petsc
