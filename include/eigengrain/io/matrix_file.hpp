#pragma once

#include "eigengrain/assembly/linear_system.hpp"
#include "eigengrain/assembly/model.hpp"

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

/// K, M, B and D of a model for other programs (docs/matrix-files.md).
namespace eigengrain::io {

/// What they are written as.
enum class MatrixFormat {
  matrix_market,  ///< K.mtx, M.mtx, B.mtx, D.mtx: text, from 1; of symmetric matrices the lower triangle
  petsc,          ///< K.petsc, ...: PETSc's binary, as MatLoad reads it
  hdf5,           ///< matrices.h5: blocks, the map of the unknowns, elements and bodies
  csv             ///< contacts.csv, bodies.csv, unknowns.csv
};

/// "mtx", "petsc", "h5", "csv"
inline constexpr std::string_view matrix_format_names[] = {"mtx", "petsc", "h5", "csv"};

/// Throws InputError for a name that is none, with the one that was probably meant.
MatrixFormat matrix_format(std::string_view name);

/// Writes the files of these formats into the folder, which is made; each appears whole or not at all.
/// Returns their paths. Bodies are named by identity, as scenes and other results do; `unknowns` say which
/// unknown is whose.
///
/// system  of the model. Throws InputError where a file cannot be written.
std::vector<std::filesystem::path> export_matrices(const assembly::Model& model,
                                                   const assembly::LinearSystem& system,
                                                   std::span<const MatrixFormat> formats,
                                                   const std::filesystem::path& folder);

}  // namespace eigengrain::io
