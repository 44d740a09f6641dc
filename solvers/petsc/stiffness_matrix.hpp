#pragma once

#include "eigengrain/assembly/stiffness_parts.hpp"
#include "eigengrain/assembly/unknowns.hpp"
#include "eigengrain/contact/element.hpp"

#include "handles.hpp"

#include <span>

namespace eigengrain::petsc {

/// K as an assembled PETSc matrix: BAIJ with blocks of 3, both triangles; masked rows and columns are zero.
///
/// The pattern is laid down once, for a contact graph. It is then a sink of assembly::assemble_stiffness and
/// of assembly::assemble_tangent, and
///
///     matrix.begin(); assemble_stiffness(model, matrix); matrix.end();
///
/// may be repeated as often as stiffnesses change, without any allocation. It refers to the unknowns given.
class StiffnessMatrix {
 public:
  /// parts: the contacts whose ends make the pattern, and the blocks of nodes; their stiffness is not read.
  StiffnessMatrix(const assembly::Unknowns& unknowns, const assembly::StiffnessParts& parts);

  void begin();
  void add(const contact::ContactElement& element);
  /// The 12×12 of a contact on (u_a, θ_a, u_b, θ_b); at a wall (b = contact::no_body) the first 6×6 of it.
  void add(std::int32_t a, std::int32_t b, const Mat12& k);
  /// A block of the pattern.
  void add_block(std::int32_t row, std::int32_t column, const Mat3& block);
  void end();

  Mat mat() const { return matrix_.get(); }

 private:
  const assembly::Unknowns* unknowns_;
  Matrix matrix_;
};

}  // namespace eigengrain::petsc
