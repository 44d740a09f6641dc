#pragma once

#include <pybind11/pybind11.h>

#include <mutex>

namespace eigengrain::python {

/// While it lives other Python threads run, and nobody else works with PETSc, which is not made for threads
/// of the caller's own. The GIL is given back before the turn is waited for, and taken again after it is
/// over.
class PetscWork {
 public:
  PetscWork() : turn_(mutex()) {}

 private:
  static std::mutex& mutex() {
    static std::mutex one;
    return one;
  }
  pybind11::gil_scoped_release open_;
  std::lock_guard<std::mutex> turn_;
};

}  // namespace eigengrain::python
