#include "eigengrain/petsc/session.hpp"

#include "eigengrain/base/error.hpp"
#include "eigengrain/base/parallel.hpp"

#include "error.hpp"

#include <dlfcn.h>
#include <fmt/format.h>
#include <slepcsys.h>

#include <string_view>

namespace eigengrain::petsc {
namespace {

constexpr std::string_view signal_option = "no_signal_handler";

/// OpenBLAS is reached by name: the program runs with any BLAS. Its OpenMP build would set our threads too.
void one_blas_thread() {
  const int ours = threads();
  using SetThreads = void (*)(int);
  if (void* found = dlsym(RTLD_DEFAULT, "openblas_set_num_threads")) reinterpret_cast<SetThreads>(found)(1);
  set_threads(ours);
}

class Session {
 public:
  Session() {
    PetscBool running = PETSC_FALSE;
    EIGENGRAIN_PETSC(SlepcInitialized(&running));
    if (running == PETSC_FALSE) {
      // Signals stay ours: PETSc's handlers would end the program instead of letting it save its state.
      EIGENGRAIN_PETSC(PetscOptionsSetValue(nullptr, "-no_signal_handler", "true"));
      EIGENGRAIN_PETSC(SlepcInitializeNoArguments());
      ours_ = true;
    }
    // Errors come back as codes, for check() to report, and not as a printed trace.
    EIGENGRAIN_PETSC(PetscPushErrorHandler(PetscIgnoreErrorHandler, nullptr));
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
  const std::size_t first = options.find_first_not_of(' ');
  if (first == std::string::npos) return;
  if (options[first] != '-' || PetscOptionsInsertString(nullptr, options.c_str()) != 0)
    throw InputError(
        fmt::format("--petsc \"{}\": PETSc cannot read this; write options as in \"-eps_ncv 80\"", options));
}

void require_options_used() {
  PetscInt count = 0;
  char** names = nullptr;
  EIGENGRAIN_PETSC(PetscOptionsLeftGet(nullptr, &count, &names, nullptr));
  std::string unused;
  for (PetscInt k = 0; k < count; ++k) {
    if (std::string_view(names[k]) == signal_option) continue;  // our own; PETSc reads it only when it starts
    unused += fmt::format("{}-{}", unused.empty() ? "" : ", ", names[k]);
  }
  EIGENGRAIN_PETSC(PetscOptionsLeftRestore(nullptr, &count, &names, nullptr));
  if (!unused.empty())
    throw InputError(fmt::format(
        "--petsc: nothing uses {}; timestep takes the options of SLEPc's EPS, e.g. -eps_ncv 80, and, with "
        "dashpots, PEP (not up to 48 unknowns, which are dense), relax those of PETSc's SNES behind "
        "relax_, e.g. -relax_ksp_type gmres",
        unused));
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
