#include "eigengrain/fem/elements.hpp"

#include "eigengrain/base/parallel.hpp"
#include "eigengrain/fem/material.hpp"

#include <array>
#include <cmath>

namespace eigengrain::fem {
namespace {

using model::ElementKind;
using model::Mesh;

/// Shape functions and their derivatives by the element's own coordinates, at a point of these.
struct Shape {
  Eigen::Matrix<double, most_nodes, 1> value = Eigen::Matrix<double, most_nodes, 1>::Zero();
  Eigen::Matrix<double, most_nodes, 3> derivative = Eigen::Matrix<double, most_nodes, 3>::Zero();
};

struct Point {
  Vec3 place;
  double weight;
};

Shape tet4_shape(const Vec3& r) {
  Shape shape;
  shape.value.head<4>() << 1 - r.sum(), r;
  shape.derivative.row(0).setConstant(-1);
  for (int k = 0; k < 3; ++k) shape.derivative(k + 1, k) = 1;
  return shape;
}

/// Corners (2 L_i - 1) L_i, middles of edges 4 L_i L_j.
Shape tet10_shape(const Vec3& r) {
  static constexpr std::array<std::array<int, 2>, 6> edges{{{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}}};
  const Shape linear = tet4_shape(r);
  Shape shape;
  for (int i = 0; i < 4; ++i) {
    const double l = linear.value[i];
    shape.value[i] = (2 * l - 1) * l;
    shape.derivative.row(i) = (4 * l - 1) * linear.derivative.row(i);
  }
  for (int k = 0; k < 6; ++k) {
    const auto [i, j] = edges[static_cast<std::size_t>(k)];
    shape.value[4 + k] = 4 * linear.value[i] * linear.value[j];
    shape.derivative.row(4 + k) =
        4 * (linear.value[i] * linear.derivative.row(j) + linear.value[j] * linear.derivative.row(i));
  }
  return shape;
}

Shape hex8_shape(const Vec3& r) {
  static constexpr std::array<std::array<double, 3>, 8> corners{
      {{-1, -1, -1}, {1, -1, -1}, {1, 1, -1}, {-1, 1, -1}, {-1, -1, 1}, {1, -1, 1}, {1, 1, 1}, {-1, 1, 1}}};
  Shape shape;
  for (int i = 0; i < 8; ++i) {
    const auto& c = corners[static_cast<std::size_t>(i)];
    const Vec3 part(1 + c[0] * r[0], 1 + c[1] * r[1], 1 + c[2] * r[2]);
    shape.value[i] = part.prod() / 8;
    for (int k = 0; k < 3; ++k)
      shape.derivative(i, k) = c[static_cast<std::size_t>(k)] * part[(k + 1) % 3] * part[(k + 2) % 3] / 8;
  }
  return shape;
}

Shape shape_at(ElementKind kind, const Vec3& r) {
  switch (kind) {
    case ElementKind::hex8:
      return hex8_shape(r);
    case ElementKind::tet10:
      return tet10_shape(r);
    case ElementKind::tet4:
      break;
  }
  return tet4_shape(r);
}

std::vector<Point> gauss_cube(std::span<const double> places, std::span<const double> weights) {
  std::vector<Point> points;
  for (std::size_t k = 0; k < places.size(); ++k)
    for (std::size_t j = 0; j < places.size(); ++j)
      for (std::size_t i = 0; i < places.size(); ++i)
        points.push_back({{places[i], places[j], places[k]}, weights[i] * weights[j] * weights[k]});
  return points;
}

/// For stiffness.
std::vector<Point> points_of(ElementKind kind) {
  static const double gauss = 1 / std::sqrt(3.0);
  static const double near = (5 - std::sqrt(5.0)) / 20;
  static const double far = 1 - 3 * near;
  switch (kind) {
    case ElementKind::hex8:
      return gauss_cube(std::array{-gauss, gauss}, std::array{1.0, 1.0});
    case ElementKind::tet10:
      return {{{near, near, near}, 1.0 / 24},
              {{far, near, near}, 1.0 / 24},
              {{near, far, near}, 1.0 / 24},
              {{near, near, far}, 1.0 / 24}};
    case ElementKind::tet4:
      break;
  }
  return {{Vec3::Constant(0.25), 1.0 / 6}};
}

/// For masses, exact for products of two shape functions in undistorted elements: of tetrahedra the collapsed
/// rule of Gauss and Jacobi would do; here the cube's points are collapsed with their own Jacobian, which is
/// a polynomial too.
std::vector<Point> mass_points_of(ElementKind kind) {
  static const double far = std::sqrt((3 + 2 * std::sqrt(1.2)) / 7);
  static const double near = std::sqrt((3 - 2 * std::sqrt(1.2)) / 7);
  static const double of_far = (18 - std::sqrt(30.0)) / 36;
  static const double of_near = (18 + std::sqrt(30.0)) / 36;
  std::vector<Point> points =
      gauss_cube(std::array{-far, -near, near, far}, std::array{of_far, of_near, of_near, of_far});
  if (kind == ElementKind::hex8) return points;
  for (Point& point : points) {
    const Vec3 s = 0.5 * (point.place + Vec3::Ones());
    point.weight *= (1 - s[2]) * (1 - s[2]) * (1 - s[1]) / 8;
    point.place = {s[0] * (1 - s[1]) * (1 - s[2]), s[1] * (1 - s[2]), s[2]};
  }
  return points;
}

/// Places of the nodes of an element as rows.
Eigen::Matrix<double, most_nodes, 3> places_of(const Mesh& mesh, std::int32_t e) {
  Eigen::Matrix<double, most_nodes, 3> places = Eigen::Matrix<double, most_nodes, 3>::Zero();
  int row = 0;
  for (const std::int32_t node : mesh.element(e))
    places.row(row++) = mesh.nodes[static_cast<std::size_t>(node)];
  return places;
}

}  // namespace

Elements::Elements(const Mesh& mesh)
    : nodes_(model::nodes_of(mesh.kind)), points_(0), size_(mesh.element_count()) {
  std::vector<double> weights;
  std::vector<Shape> shapes;
  for (const Point& point : points_of(mesh.kind)) {
    shapes.push_back(shape_at(mesh.kind, point.place));
    weights.push_back(point.weight);
  }
  points_ = static_cast<int>(shapes.size());
  weight_.resize(static_cast<std::size_t>(size_) * shapes.size());
  gradient_.resize(weight_.size() * static_cast<std::size_t>(3 * nodes_));
  for_each_index(size_, [&](std::int64_t index) {
    const auto e = static_cast<std::int32_t>(index);
    const auto places = places_of(mesh, e);
    for (int q = 0; q < points_; ++q) {
      const Shape& shape = shapes[static_cast<std::size_t>(q)];
      const Mat3 jacobian = shape.derivative.transpose() * places;  // ∂x/∂r, transposed
      weight_[at(e, q)] = weights[static_cast<std::size_t>(q)] * jacobian.determinant();
      const Eigen::Matrix<double, most_nodes, 3> gradient = shape.derivative * jacobian.inverse().transpose();
      double* numbers = &gradient_[static_cast<std::size_t>(3 * nodes_) * at(e, q)];
      for (int i = 0; i < nodes_; ++i) Eigen::Map<Vec3>(numbers + 3 * i) = gradient.row(i);
    }
  });
}

Mat3 Elements::deformation(std::int32_t e, int q, std::span<const Vec3> x) const {
  const double* gradient = gradients(e, q).data();
  Mat3 F = Mat3::Zero();
  for (int i = 0; i < nodes_; ++i)
    F += x[static_cast<std::size_t>(i)] * Eigen::Map<const Vec3>(gradient + 3 * i).transpose();
  return F;
}

void Elements::forces(const model::ElasticSolid& solid, std::int32_t e, std::span<const Vec3> x,
                      std::span<Vec3> forces) const {
  for (int i = 0; i < nodes_; ++i) forces[static_cast<std::size_t>(i)].setZero();
  for (int q = 0; q < points_; ++q) {
    const Mat3 P = -weight(e, q) * stress(solid, deformation(e, q, x));
    const double* gradient = gradients(e, q).data();
    for (int i = 0; i < nodes_; ++i)
      forces[static_cast<std::size_t>(i)] += P * Eigen::Map<const Vec3>(gradient + 3 * i);
  }
}

double Elements::energy(const model::ElasticSolid& solid, std::int32_t e, std::span<const Vec3> x) const {
  double sum = 0;
  for (int q = 0; q < points_; ++q) sum += weight(e, q) * energy_density(solid, deformation(e, q, x));
  return sum;
}

Eigen::MatrixXd Elements::stiffness(const model::ElasticSolid& solid, std::int32_t e,
                                    std::span<const Vec3> x) const {
  Eigen::MatrixXd K = Eigen::MatrixXd::Zero(3 * nodes_, 3 * nodes_);
  for (int q = 0; q < points_; ++q) {
    const Mat9 A = weight(e, q) * elasticity(solid, deformation(e, q, x));
    const double* gradient = gradients(e, q).data();
    // F is nine numbers column after column, and column k has component k of ∇N.
    Eigen::Matrix<double, 9, 3> right;
    for (int j = 0; j < nodes_; ++j) {
      right.setZero();
      for (int k = 0; k < 3; ++k) right += gradient[3 * j + k] * A.middleCols<3>(3 * k);
      for (int i = 0; i < nodes_; ++i)
        for (int k = 0; k < 3; ++k)
          K.block<3, 3>(3 * i, 3 * j) += gradient[3 * i + k] * right.middleRows<3>(3 * k);
    }
  }
  return 0.5 * (K + K.transpose());  // symmetric to the bit
}

Mat3 Elements::mean_stress(const model::ElasticSolid& solid, std::int32_t e, std::span<const Vec3> x) const {
  Mat3 sum = Mat3::Zero();
  double volume = 0;
  for (int q = 0; q < points_; ++q) {
    const Mat3 F = deformation(e, q, x);
    const double now = weight(e, q) * (solid.model == model::ElasticModel::linear ? 1.0 : F.determinant());
    sum += now * cauchy_stress(solid, F);
    volume += now;
  }
  return sum / volume;
}

Eigen::MatrixXd consistent_mass(const Mesh& mesh, std::int32_t element, double density) {
  const int nodes = model::nodes_of(mesh.kind);
  const auto places = places_of(mesh, element);
  Eigen::MatrixXd mass = Eigen::MatrixXd::Zero(nodes, nodes);
  for (const Point& point : mass_points_of(mesh.kind)) {
    const Shape shape = shape_at(mesh.kind, point.place);
    const double volume = point.weight * Mat3(shape.derivative.transpose() * places).determinant();
    mass += density * volume * shape.value.head(nodes) * shape.value.head(nodes).transpose();
  }
  return mass;
}

std::vector<double> lumped_masses(const Mesh& mesh, double density) {
  std::vector<double> masses(mesh.nodes.size(), 0.0);
  for (std::int32_t e = 0; e < mesh.element_count(); ++e) {
    const Eigen::MatrixXd consistent = consistent_mass(mesh, e, density);
    const double scale = consistent.sum() / consistent.trace();
    int i = 0;
    for (const std::int32_t node : mesh.element(e)) {
      masses[static_cast<std::size_t>(node)] += scale * consistent(i, i);
      ++i;
    }
  }
  return masses;
}

}  // namespace eigengrain::fem
