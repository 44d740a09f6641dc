// eigengrain._core: the library as the package eigengrain sees it. The package has the docstrings.
#include "eigengrain/base/error.hpp"
#include "eigengrain/base/parallel.hpp"
#include "eigengrain/io/schema.hpp"
#include "eigengrain/petsc/session.hpp"

#include "parts.hpp"

#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <exception>
#include <string>

namespace py = pybind11;

namespace eigengrain::python {

void look_for_interrupt() {
  const py::gil_scoped_acquire gil;
  if (PyErr_CheckSignals() != 0) throw py::error_already_set();
}

namespace {

/// The exceptions of the package, with the messages of the program. Looked up there when one is thrown.
void raise_as(const char* name, const std::string& message, const py::object& mistakes) {
  const py::object type = py::module_::import("eigengrain.errors").attr(name);
  py::object error = type(message);
  if (!mistakes.is_none()) error.attr("mistakes") = mistakes;
  PyErr_SetObject(type.ptr(), error.ptr());
}

void translate(std::exception_ptr thrown) {
  try {
    if (thrown) std::rethrow_exception(thrown);
  } catch (const InputError& error) {
    py::list mistakes;
    for (const Mistake& mistake : error.mistakes())
      mistakes.append(py::make_tuple(mistake.file, mistake.line, mistake.message));
    raise_as("InputError", error.what(), mistakes);
  } catch (const SolverError& error) {
    raise_as("SolverError", error.what(), py::none());
  }
}

}  // namespace
}  // namespace eigengrain::python

PYBIND11_MODULE(_core, module) {
  using namespace eigengrain;
  py::register_exception_translator(python::translate);
  module.attr("__version__") = EIGENGRAIN_VERSION;
  module.def(
      "set_threads",
      [](int threads) {
        if (threads < 0)
          throw InputError("set_threads: " + std::to_string(threads) +
                           "; write a number from 1 up, or 0 for one per processor");
        set_threads(threads);
      },
      py::arg("threads"));
  module.def("threads", threads);
  module.def("schema_markdown", io::schema_markdown);
  module.def("set_petsc_options", petsc::set_options, py::arg("options"));
  python::add_states(module);
  python::add_systems(module);
  python::add_questions(module);
  python::add_spectra(module);
}
