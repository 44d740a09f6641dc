#pragma once

#include "eigengrain/assembly/product.hpp"

#include "petsc/handles.hpp"

#include <Eigen/Core>

#include <cstdint>
#include <span>
#include <vector>

/// Matrix-free products and their vectors as PETSc's. All vectors are [unknowns.size()] with zeros at masked
/// components.
namespace eigengrain::timestep {

/// What SLEPc sees of a product: y = factor · S K S x. Refers to the product; the same place for life, as
/// PETSc keeps a pointer to it.
class ProductShell {
 public:
  explicit ProductShell(assembly::StiffnessProduct& product, double factor = 1);
  ProductShell(const ProductShell&) = delete;
  ProductShell& operator=(const ProductShell&) = delete;

  Mat mat() const { return matrix_.get(); }
  void multiply(Vec x, Vec y);

 private:
  assembly::StiffnessProduct& product_;
  double factor_;
  petsc::Matrix matrix_;
};

/// A product as a dense matrix, column by column.
Eigen::MatrixXd dense(assembly::StiffnessProduct& product);
/// Whether a system of so many unknowns is solved as a dense matrix.
bool is_dense(std::int64_t unknowns);

/// gaussian_start() as a vector of the matrix.
petsc::Vector start_vector(Mat matrix, std::span<const double> scale, std::uint64_t seed);
petsc::Vector like(Vec x);
double dot(Vec x, Vec y);
double norm(Vec x);
void copy(const Eigen::VectorXd& from, Vec to);
/// S y / |y|: the mode that belongs to a vector of the scaled problem.
std::vector<double> mode_of(Vec y, std::span<const double> scale);

}  // namespace eigengrain::timestep
