#pragma once

#include <pybind11/pybind11.h>

/// What the module consists of: one file each.
namespace eigengrain::python {

void add_states(pybind11::module_& module);
void add_systems(pybind11::module_& module);
void add_questions(pybind11::module_& module);
void add_spectra(pybind11::module_& module);

/// Raises KeyboardInterrupt where the user has asked for an end. Takes the GIL.
void look_for_interrupt();

}  // namespace eigengrain::python
