// Modes, density of states, rigidity, moduli, and files of matrices.
#include "eigengrain/base/error.hpp"
#include "eigengrain/io/matrix_file.hpp"
#include "eigengrain/io/mode_file.hpp"
#include "eigengrain/petsc/session.hpp"
#include "eigengrain/spectrum/density.hpp"
#include "eigengrain/spectrum/modes.hpp"
#include "eigengrain/spectrum/moduli.hpp"
#include "eigengrain/spectrum/rigidity.hpp"

#include "arrays.hpp"
#include "handle.hpp"
#include "parts.hpp"
#include "petsc_work.hpp"
#include "system.hpp"

#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <exception>
#include <string>
#include <utility>
#include <vector>

namespace eigengrain::python {
namespace {

using py::literals::operator""_a;
using SharedSystem = std::shared_ptr<System>;
using Snapshot = std::shared_ptr<const assembly::State>;

/// Rows of one length as one array [rows × length].
py::array rows_of(const std::vector<std::vector<double>>& rows, std::size_t length) {
  std::vector<double> all;
  all.reserve(rows.size() * length);
  for (const std::vector<double>& row : rows) all.insert(all.end(), row.begin(), row.end());
  return owned(std::move(all)).attr("reshape")(rows.size(), length);
}

py::dict to_dict(const System& self, spectrum::Modes modes) {
  std::vector<double> participation;
  std::vector<double> translation;
  for (const std::vector<double>& shape : modes.shape) {
    const spectrum::Character character = spectrum::character_of(self.system, shape);
    participation.push_back(character.participation);
    translation.push_back(character.translation);
  }
  py::array shapes = rows_of(modes.shape, self.system.mass.size());
  return py::dict("eigenvalues"_a = owned(std::move(modes.lambda)),
                  "residuals"_a = owned(std::move(modes.residual)), "shapes"_a = std::move(shapes),
                  "participation"_a = owned(std::move(participation)),
                  "translation"_a = owned(std::move(translation)));
}

template <class Find>
py::dict modes_by(const SharedSystem& self, const Find& find) {
  spectrum::Modes found;
  {
    const PetscWork work;
    found = find(self->system);
  }
  return to_dict(*self, std::move(found));
}

py::dict density(const SharedSystem& self, int moments, int vectors, int bins, std::uint64_t seed) {
  std::exception_ptr interrupt;
  spectrum::DensityOptions options{.moments = moments, .vectors = vectors, .bins = bins, .seed = seed};
  options.interrupted = [&] {
    try {
      look_for_interrupt();
    } catch (const py::error_already_set&) {
      interrupt = std::current_exception();
    }
    return static_cast<bool>(interrupt);
  };
  spectrum::Density found;
  {
    const PetscWork work;
    found = spectrum::density_of_states(self->system, options);
  }
  if (interrupt) std::rethrow_exception(interrupt);
  return py::dict("edges"_a = owned(std::move(found.edge)), "count"_a = owned(std::move(found.count)),
                  "error"_a = owned(std::move(found.error)), "resolution"_a = found.resolution,
                  "modes"_a = found.modes, "products"_a = found.products, "seconds"_a = found.seconds);
}

spectrum::Springs springs_of(const std::string& word) {
  if (word == "all") return spectrum::Springs::all;
  if (word == "sticking") return spectrum::Springs::sticking;
  if (word == "normal") return spectrum::Springs::normal;
  throw InputError("springs: \"" + word + "\" is none of all, sticking, normal");
}

py::dict rigidity(const Handle& handle, const std::string& springs, bool with_rattlers, bool shapes) {
  const Snapshot state = handle.state();
  const spectrum::RigidityOptions options{springs_of(springs), with_rattlers, shapes};
  spectrum::Rigidity found;
  {
    const PetscWork work;
    found = spectrum::rigidity(state->model, options);
  }
  const auto bodies = static_cast<std::size_t>(state->model.bodies.size());
  py::dict result("bodies"_a = found.bodies, "rattlers"_a = found.rattlers, "set_aside"_a = found.set_aside,
                  "contacts"_a = found.contacts, "springs"_a = found.springs.size(),
                  "unknowns"_a = found.unknowns, "floppy"_a = found.floppy, "trivial"_a = found.trivial,
                  "self_stress"_a = found.self_stress, "excess"_a = found.excess(),
                  "counts_agree"_a = found.counts_agree(), "floppy_residual"_a = found.floppy_residual,
                  "stress_residual"_a = found.stress_residual, "seconds"_a = found.seconds);
  result["floppy_u"] = rows_of(found.floppy_u, 3 * bodies).attr("reshape")(found.floppy_u.size(), bodies, 3);
  result["floppy_theta"] =
      rows_of(found.floppy_theta, 3 * bodies).attr("reshape")(found.floppy_theta.size(), bodies, 3);
  result["stresses"] = rows_of(found.stress, found.springs.size());
  std::vector<std::int32_t> a;
  std::vector<std::int32_t> b;
  std::vector<std::uint8_t> kind;
  std::vector<Vec3> direction;
  for (const spectrum::Spring& spring : found.springs) {
    a.push_back(spring.a);
    b.push_back(spring.b);
    kind.push_back(static_cast<std::uint8_t>(spring.kind));
    direction.push_back(spring.direction);
  }
  result["spring_a"] = owned(std::move(a));
  result["spring_b"] = owned(std::move(b));
  result["spring_kind"] = owned(std::move(kind));
  result["spring_direction"] = owned(std::move(direction));
  return result;
}

py::dict moduli(const Handle& handle) {
  const Snapshot state = handle.state();
  spectrum::Moduli found;
  {
    const PetscWork work;
    found = spectrum::elastic_moduli(state->model);
  }
  py::list displacement;
  py::list rotation;
  for (std::size_t k = 0; k < 6; ++k) {
    displacement.append(owned(std::move(found.displacement[k])));
    rotation.append(owned(std::move(found.rotation[k])));
  }
  return py::dict("stiffness"_a = matrix(found.stiffness), "affine"_a = matrix(found.affine),
                  "volume"_a = found.volume, "contacts"_a = found.contacts, "bulk"_a = found.bulk(),
                  "shear"_a = found.shear(),
                  "residuals"_a = std::vector<double>(found.residual.begin(), found.residual.end()),
                  "iterations"_a = found.iterations, "seconds"_a = found.seconds,
                  "displacement"_a = displacement, "rotation"_a = rotation);
}

std::vector<std::string> export_matrices(const SharedSystem& self, const std::string& folder,
                                         const std::vector<std::string>& names) {
  std::vector<io::MatrixFormat> formats;
  for (const std::string& name : names) formats.push_back(io::matrix_format(name));
  std::vector<std::string> result;  // with the GIL, for HDF5
  for (const auto& file : io::export_matrices(self->state->model, self->system, formats, folder))
    result.push_back(file.string());
  return result;
}

void write_modes(const SharedSystem& self, const std::string& file,
                 const py::array_t<double, py::array::c_style | py::array::forcecast>& shapes) {
  const auto size = static_cast<py::ssize_t>(self->system.mass.size());
  if (shapes.ndim() != 2 || shapes.shape(1) != size)
    throw InputError("shapes: an array of shape (modes, " + std::to_string(size) + ") is wanted");
  std::vector<spectrum::BodyMotion> motions;
  for (py::ssize_t k = 0; k < shapes.shape(0); ++k)
    motions.push_back(
        spectrum::motion_of_bodies(self->system, {shapes.data() + k * size, static_cast<std::size_t>(size)}));
  std::vector<io::ModeShape> drawn;
  for (const spectrum::BodyMotion& motion : motions)
    drawn.push_back({motion.displacement, motion.rotation, motion.energy});
  io::write_modes(file, self->state->model.bodies, drawn);
}

}  // namespace

void add_spectra(py::module_& module) {
  module.def(
      "highest_modes",
      [](const SharedSystem& self, int count) {
        return modes_by(self, [&](const auto& system) { return spectrum::highest_modes(system, count); });
      },
      py::arg("system"), py::arg("count"));
  module.def(
      "lowest_modes",
      [](const SharedSystem& self, int count) {
        return modes_by(self, [&](const auto& system) { return spectrum::lowest_modes(system, count); });
      },
      py::arg("system"), py::arg("count"));
  module.def(
      "all_modes",
      [](const SharedSystem& self, bool shapes) {
        return modes_by(self, [&](const auto& system) { return spectrum::all_modes(system, shapes); });
      },
      py::arg("system"), py::arg("shapes"));
  module.def("density_of_states", &density, py::arg("system"), py::arg("moments"), py::arg("vectors"),
             py::arg("bins"), py::arg("seed"));
  module.def("smeared", &spectrum::smeared, py::arg("eigenvalue"), py::arg("bound"), py::arg("moments"),
             py::arg("edges"));
  module.def("rigidity", &rigidity, py::arg("state"), py::arg("springs"), py::arg("with_rattlers"),
             py::arg("shapes"));
  module.def("moduli", &moduli, py::arg("state"));
  module.def("export_matrices", &export_matrices, py::arg("system"), py::arg("folder"), py::arg("formats"));
  module.def("write_modes", &write_modes, py::arg("system"), py::arg("file"), py::arg("shapes"));
}

}  // namespace eigengrain::python
