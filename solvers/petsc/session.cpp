#include "eigengrain/petsc/session.hpp"

#include "eigengrain/base/error.hpp"

#include "error.hpp"

#include <dlfcn.h>
#include <fmt/format.h>
#include <slepcsys.h>

#include <array>

namespace eigengrain::petsc {
namespace {

/// OpenBLAS is reached by name: the program runs with any BLAS.
void one_blas_thread() {
  using SetThreads = void (*)(int);
  if (void* found = dlsym(RTLD_DEFAULT, "openblas_set_num_threads")) reinterpret_cast<SetThreads>(found)(1);
}

class Session {
 public:
  Session() {
    PetscBool running = PETSC_FALSE;
    check(SlepcInitialized(&running), "SlepcInitialized");
    if (running == PETSC_FALSE) {
      // Signals stay ours: PETSc's handlers would end the program instead of letting it save its state.
      PetscOptionsSetValue(nullptr, "-no_signal_handler", "true");
      check(SlepcInitializeNoArguments(), "SlepcInitializeNoArguments");
      ours_ = true;
    }
    // Errors come back as codes, for check() to report, and not as a printed trace.
    check(PetscPushErrorHandler(PetscIgnoreErrorHandler, nullptr), "PetscPushErrorHandler");
    one_blas_thread();
  }
  ~Session() {
    PetscBool finished = PETSC_FALSE;
    PetscFinalized(&finished);
    if (ours_ && finished == PETSC_FALSE) SlepcFinalize();
  }
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

 private:
  bool ours_ = false;
};

}  // namespace

void start() {
  static const Session session;
}

void set_options(const std::string& options) {
  start();
  if (PetscOptionsInsertString(nullptr, options.c_str()) != 0)
    throw InputError(
        fmt::format("--petsc \"{}\": PETSc cannot read this; write options as in \"-eps_ncv 80\"", options));
}

void check(PetscErrorCode code, const char* call) {
  if (code == 0) return;
  const char* text = nullptr;
  char* specific = nullptr;
  PetscErrorMessage(code, &text, &specific);
  throw SolverError(fmt::format("{} failed with PETSc error {}: {}{}{}", call, static_cast<int>(code),
                                text != nullptr ? text : "no description", specific != nullptr ? "; " : "",
                                specific != nullptr ? specific : ""));
}

}  // namespace eigengrain::petsc
