#pragma once

#include "eigengrain/base/vec.hpp"
#include "eigengrain/model/bodies.hpp"

#include <pybind11/numpy.h>

#include <memory>
#include <utility>
#include <vector>

/// Columns of the library as numpy arrays that are read only and keep what they show alive. Nobody changes
/// what they show: whoever goes on works on a copy (see Handle).
namespace eigengrain::python {

namespace py = pybind11;

/// How a row of a column is seen from numpy: so many numbers of one type.
template <class T>
struct Row {
  using Number = T;
  static constexpr int components = 1;
};
template <>
struct Row<Vec3> {
  using Number = double;
  static constexpr int components = 3;
};
template <>
struct Row<Quat> {
  using Number = double;
  static constexpr int components = 4;
};
template <>
struct Row<Mat3> {
  using Number = double;
  static constexpr int components = 9;
};
template <>
struct Row<model::FixedComponents> {
  using Number = std::uint8_t;
  static constexpr int components = 1;
};
template <>
struct Row<model::Image> {
  using Number = std::int8_t;
  static constexpr int components = 3;
};

/// `count` rows of numbers that belong to `owner`, without a copy. Writable only where they are made for
/// whoever asks.
template <class Number>
py::array view(const Number* data, std::size_t count, int components, std::shared_ptr<const void> owner,
               bool writable = false) {
  const py::capsule keeper(new std::shared_ptr<const void>(std::move(owner)),
                           [](void* kept) { delete static_cast<std::shared_ptr<const void>*>(kept); });
  std::vector<py::ssize_t> shape{static_cast<py::ssize_t>(count)};
  if (components > 1) shape.push_back(components);
  py::array result(py::dtype::of<Number>(), std::move(shape), data, keeper);
  if (!writable) result.attr("setflags")(py::arg("write") = false);
  return result;
}

template <class T>
py::array view(const std::vector<T>& column, std::shared_ptr<const void> owner, bool writable = false) {
  using Number = typename Row<T>::Number;
  static_assert(sizeof(T) == Row<T>::components * sizeof(Number));
  return view(reinterpret_cast<const Number*>(column.data()), column.size(), Row<T>::components,
              std::move(owner), writable);
}

/// A column that is handed over.
template <class T>
py::array owned(std::vector<T> column) {
  const auto owner = std::make_shared<const std::vector<T>>(std::move(column));
  return view(*owner, owner, true);
}

/// A column that may be absent.
template <class T>
py::object view_or_none(const std::vector<T>& column, std::shared_ptr<const void> owner) {
  return column.empty() ? py::object(py::none()) : py::object(view(column, std::move(owner)));
}

inline py::array_t<double> matrix(const Eigen::MatrixXd& values) {
  py::array_t<double> result({values.rows(), values.cols()});
  auto to = result.mutable_unchecked<2>();
  for (Eigen::Index i = 0; i < values.rows(); ++i)
    for (Eigen::Index j = 0; j < values.cols(); ++j) to(i, j) = values(i, j);
  return result;
}

}  // namespace eigengrain::python
