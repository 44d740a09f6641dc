// K, M, B, D of a state: as arrays for scipy, as a product without K, and the map of the unknowns.
#include "eigengrain/assembly/block_matrix.hpp"
#include "eigengrain/base/error.hpp"

#include "arrays.hpp"
#include "handle.hpp"
#include "parts.hpp"
#include "system.hpp"

#include <pybind11/pybind11.h>

#include <string>
#include <vector>

namespace eigengrain::python {
namespace {

using assembly::BlockMatrix;
using assembly::LinearSystem;
using assembly::Unknowns;
using Numbers = py::array_t<double, py::array::c_style | py::array::forcecast>;
using SharedSystem = std::shared_ptr<System>;

SharedSystem system_of(const Handle& handle, bool all) {
  const std::shared_ptr<const assembly::State> state = handle.state();
  const py::gil_scoped_release open;
  return std::make_shared<System>(
      state, LinearSystem(state->model, all ? assembly::Listed::all : assembly::Listed::acting));
}

/// (data [blocks × 3 × 3], columns, offsets), as scipy.sparse.bsr_matrix takes them.
py::tuple for_scipy(BlockMatrix matrix) {
  const auto kept = std::make_shared<BlockMatrix>(std::move(matrix));
  return py::make_tuple(view(kept->values, kept, true), view(kept->columns, kept, true),
                        view(kept->offsets, kept, true), kept->rows(), kept->column_count());
}

template <class Make>
py::tuple matrix_of(const SharedSystem& self, const Make& make) {
  BlockMatrix result;
  {
    const py::gil_scoped_release open;
    result = make(self->system);
  }
  return for_scipy(std::move(result));
}

/// [bodies] the block of each body's u or θ, or -1.
template <class Block>
py::array blocks_of_bodies(const Unknowns& unknowns, const Block& block) {
  std::vector<std::int32_t> result;
  for (std::int32_t body = 0; body < unknowns.bodies(); ++body) result.push_back(block(body));
  return owned(std::move(result));
}

void require_numbers(const Numbers& x, std::int64_t size) {
  if (x.ndim() != 1 || x.shape(0) != size)
    throw InputError("a vector of " + std::to_string(size) + " unknowns is wanted, not one of shape (" +
                     (x.ndim() > 0 ? std::to_string(x.shape(0)) : std::string()) +
                     (x.ndim() > 1 ? ", ...)" : ",)"));
}

/// A vector of unknowns as u and θ (along the axes of space) of all bodies [bodies × 3], zeros where there is
/// none; of clumps in the row of the holder.
py::tuple to_bodies(const System& self, const Numbers& x) {
  const Unknowns& unknowns = self.system.unknowns;
  require_numbers(x, unknowns.size());
  std::vector<Vec3> u(static_cast<std::size_t>(unknowns.bodies()), Vec3::Zero());
  std::vector<Vec3> theta = u;
  for (std::int32_t block = 0; block < unknowns.blocks(); ++block) {
    const std::int32_t body = unknowns.body(block);
    const Vec3 value = Eigen::Map<const Vec3>(x.data() + std::ptrdiff_t{3} * block);
    if (!unknowns.is_rotation(block))
      u[body] = value;
    else
      theta[body] = unknowns.axes(body) != nullptr ? Vec3(*unknowns.axes(body) * value) : value;
  }
  return py::make_tuple(owned(std::move(u)), owned(std::move(theta)));
}

py::array from_bodies(const System& self, const Numbers& u, const Numbers& theta) {
  const Unknowns& unknowns = self.system.unknowns;
  for (const Numbers* rows : {&u, &theta})
    if (rows->ndim() != 2 || rows->shape(0) != unknowns.bodies() || rows->shape(1) != 3)
      throw InputError("arrays of shape (" + std::to_string(unknowns.bodies()) +
                       ", 3) are wanted, a row for each ball");
  std::vector<double> x(static_cast<std::size_t>(unknowns.size()));
  for (std::int32_t block = 0; block < unknowns.blocks(); ++block) {
    const std::int32_t body = unknowns.body(block);
    const bool turns = unknowns.is_rotation(block);
    Vec3 value = Eigen::Map<const Vec3>((turns ? theta : u).data() + std::ptrdiff_t{3} * body);
    if (turns && unknowns.axes(body) != nullptr) value = unknowns.axes(body)->transpose() * value;
    for (int k = 0; k < 3; ++k)
      x[static_cast<std::size_t>(3 * block + k)] = unknowns.is_fixed(block, k) ? 0.0 : value[k];
  }
  return owned(std::move(x));
}

/// A number of each element as an array.
template <class Number, class Of>
py::array of_elements(const System& self, const Of& of) {
  std::vector<Number> result;
  result.reserve(self.system.elements.size());
  for (const contact::ContactElement& e : self.system.elements) result.push_back(of(e));
  return owned(std::move(result));
}

Numbers apply(Product& product, const Numbers& x) {
  require_numbers(x, product.size());
  Numbers y(product.size());
  const auto size = static_cast<std::size_t>(product.size());
  const std::span<const double> from(x.data(), size);
  const std::span<double> to(y.mutable_data(), size);
  const py::gil_scoped_release open;
  product.apply(from, to);
  return y;
}

}  // namespace

void add_systems(py::module_& module) {
  using contact::ContactElement;
  py::class_<System, SharedSystem> system(module, "System");
  system.def(py::init(&system_of), py::arg("state"), py::arg("all"));
  system.def("stiffness",
             [](const SharedSystem& self) { return matrix_of(self, assembly::stiffness_blocks); });
  system.def("kinematics",
             [](const SharedSystem& self) { return matrix_of(self, assembly::kinematic_blocks); });
  system.def("elasticity",
             [](const SharedSystem& self) { return matrix_of(self, assembly::elasticity_blocks); });
  system.def("viscosity", [](const SharedSystem& self) {
    if (!self->system.has_dashpots()) throw InputError("no contact of this state has dashpots");
    return matrix_of(
        self, [](const LinearSystem& of) { return assembly::stiffness_blocks(assembly::viscous_part(of)); });
  });
  system.def_property_readonly("mass",
                               [](const SharedSystem& self) { return view(self->system.mass, self); });
  system.def_property_readonly("size", [](const System& self) { return self.system.unknowns.size(); });
  system.def_property_readonly("elements", [](const System& self) { return self.system.elements.size(); });
  system.def_property_readonly(
      "free", [](const System& self) { return owned(self.system.unknowns.free_components()); });
  system.def_property_readonly(
      "set_aside", [](const SharedSystem& self) { return view(self->system.unknowns.set_aside(), self); });
  system.def_property_readonly("translation_block", [](const System& self) {
    const Unknowns& of = self.system.unknowns;
    return blocks_of_bodies(of, [&](std::int32_t body) { return of.translation(body); });
  });
  system.def_property_readonly("rotation_block", [](const System& self) {
    const Unknowns& of = self.system.unknowns;
    return blocks_of_bodies(of, [&](std::int32_t body) { return of.rotation(body); });
  });
  system.def_property_readonly("body", [](const System& self) {
    std::vector<std::int32_t> result;
    for (std::int32_t k = 0; k < self.system.unknowns.blocks(); ++k)
      result.push_back(self.system.unknowns.body(k));
    return owned(std::move(result));
  });
  system.def_property_readonly("is_rotation", [](const System& self) {
    std::vector<std::uint8_t> result;
    for (std::int32_t k = 0; k < self.system.unknowns.blocks(); ++k)
      result.push_back(self.system.unknowns.is_rotation(k) ? 1 : 0);
    return owned(std::move(result));
  });
  system.def("to_bodies", &to_bodies, py::arg("x"));
  system.def("from_bodies", &from_bodies, py::arg("u"), py::arg("theta"));
  const auto element_column = [&](const char* name, auto number, auto of) {
    using Number = decltype(number);
    system.def_property_readonly(name, [of](const System& self) { return of_elements<Number>(self, of); });
  };
  element_column("element_a", std::int32_t{}, [](const ContactElement& e) { return e.a; });
  element_column("element_b", std::int32_t{}, [](const ContactElement& e) { return e.b; });
  element_column("element_normal", Vec3{}, [](const ContactElement& e) { return e.normal; });
  element_column("element_lever_a", Vec3{}, [](const ContactElement& e) { return e.lever_a; });
  element_column("element_lever_b", Vec3{}, [](const ContactElement& e) { return e.lever_b; });
  element_column("element_kn", double{}, [](const ContactElement& e) { return e.stiffness.normal; });
  element_column("element_ks", double{}, [](const ContactElement& e) { return e.stiffness.shear; });
  element_column("element_twist", double{}, [](const ContactElement& e) { return e.stiffness.twist; });
  element_column("element_bending", double{}, [](const ContactElement& e) { return e.stiffness.bending; });

  py::class_<Product>(module, "Product")
      .def(py::init([](const SharedSystem& of, bool scaled) {
             const py::gil_scoped_release open;
             return std::make_unique<Product>(of, scaled);
           }),
           py::arg("system"), py::arg("scaled"))
      .def("apply", &apply, py::arg("x"))
      .def_property_readonly("size", &Product::size)
      .def_property_readonly("products", &Product::products);
}

}  // namespace eigengrain::python
