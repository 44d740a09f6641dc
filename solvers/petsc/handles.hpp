#pragma once

#include "error.hpp"

#include <slepceps.h>
#include <slepcpep.h>

#include <utility>

/// Move-only owners of PETSc and SLEPc objects. They own and expose the handle; they do not wrap the API.
namespace eigengrain::petsc {

template <class Handle, PetscErrorCode (*destroy)(Handle*)>
class Owner {
 public:
  Owner() = default;
  explicit Owner(Handle handle) : handle_(handle) {}
  ~Owner() { reset(); }
  Owner(Owner&& other) noexcept : handle_(std::exchange(other.handle_, nullptr)) {}
  Owner& operator=(Owner&& other) noexcept {
    if (this != &other) {
      reset();
      handle_ = std::exchange(other.handle_, nullptr);
    }
    return *this;
  }
  Owner(const Owner&) = delete;
  Owner& operator=(const Owner&) = delete;

  Handle get() const { return handle_; }
  /// For calls that create the object: Create(..., owner.put()).
  Handle* put() {
    reset();
    return &handle_;
  }

 private:
  void reset() {
    // A destructor that runs after PETSc has been finalised finds nothing left to free.
    PetscBool finalized = PETSC_FALSE;
    PetscFinalized(&finalized);
    if (handle_ != nullptr && finalized == PETSC_FALSE) destroy(&handle_);
    handle_ = nullptr;
  }
  Handle handle_ = nullptr;
};

using Matrix = Owner<Mat, MatDestroy>;
using Vector = Owner<Vec, VecDestroy>;
using Eigensolver = Owner<EPS, EPSDestroy>;
using PolynomialEigensolver = Owner<PEP, PEPDestroy>;

}  // namespace eigengrain::petsc
