#include "eigengrain/io/matrix_file.hpp"

#include "eigengrain/assembly/block_matrix.hpp"
#include "eigengrain/base/error.hpp"
#include "eigengrain/io/suggest.hpp"
#include "eigengrain/measures/acting_contacts.hpp"

#include "atomic_file.hpp"
#include "hdf5.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <iterator>
#include <limits>

namespace eigengrain::io {
namespace {

using assembly::BlockMatrix;
using assembly::LinearSystem;
using assembly::Model;
using contact::ContactElement;
using std::filesystem::path;

constexpr int block = 3;

/// Number (i, j) of block k.
double number_of(const BlockMatrix& matrix, std::int32_t k, int i, int j) {
  return matrix.values[static_cast<std::size_t>(k) * block * block + static_cast<std::size_t>(block * i + j)];
}

/// Calls visit(row, column, value) for every number that is not zero, row after row.
template <class Visit>
void for_each_number(const BlockMatrix& matrix, const Visit& visit) {
  for (std::int32_t row = 0; row < matrix.block_rows; ++row)
    for (int i = 0; i < block; ++i)
      for (std::int32_t k = matrix.offsets[row]; k < matrix.offsets[row + 1]; ++k)
        for (int j = 0; j < block; ++j)
          if (const double value = number_of(matrix, k, i, j); value != 0)
            visit(std::int64_t{block} * row + i, std::int64_t{block} * matrix.columns[k] + j, value);
}

BlockMatrix diagonal(const std::vector<double>& numbers) {
  BlockMatrix matrix;
  matrix.block_rows = matrix.block_columns = static_cast<std::int32_t>(numbers.size() / block);
  matrix.values.assign(numbers.size() * block, 0.0);
  for (std::int32_t k = 0; k < matrix.block_rows; ++k) {
    matrix.columns.push_back(k);
    matrix.offsets.push_back(k + 1);
    for (int i = 0; i < block; ++i)
      matrix.values[static_cast<std::size_t>(k) * block * block + static_cast<std::size_t>((block + 1) * i)] =
          numbers[static_cast<std::size_t>(block * k + i)];
  }
  return matrix;
}

struct Named {
  std::string name;
  std::string what;
  BlockMatrix matrix;
  bool symmetric = true;
};

std::vector<Named> matrices_of(const LinearSystem& system) {
  std::vector<Named> matrices;
  matrices.push_back({"K", "stiffness, N/m, N, N m", assembly::stiffness_blocks(system)});
  matrices.push_back({"M", "mass, kg, kg m2", diagonal(system.mass)});
  if (!system.nodal.empty()) return matrices;  // elements have no B and D of this form
  matrices.push_back({"B", "kinematics: relative displacement (m) and rotation (rad) of each contact",
                      assembly::kinematic_blocks(system), false});
  matrices.push_back({"D", "stiffness of the contacts, N/m, N m", assembly::elasticity_blocks(system)});
  return matrices;
}

path write(const path& file, std::string_view bytes) {
  AtomicFile part(file);
  part.write(bytes);
  part.commit();
  return file;
}

path write_matrix_market(const Named& named, const path& folder) {
  const auto wanted = [&](std::int64_t row, std::int64_t column) {
    return !named.symmetric || row >= column;
  };
  std::int64_t count = 0;
  std::string body;
  for_each_number(named.matrix, [&](std::int64_t row, std::int64_t column, double value) {
    if (!wanted(row, column)) return;
    ++count;
    fmt::format_to(std::back_inserter(body), "{} {} {:.17g}\n", row + 1, column + 1, value);
  });
  const std::string head = fmt::format("%%MatrixMarket matrix coordinate real {}\n% {}: {}\n{} {} {}\n",
                                       named.symmetric ? "symmetric" : "general", named.name, named.what,
                                       named.matrix.rows(), named.matrix.column_count(), count);
  return write(folder / (named.name + ".mtx"), head + body);
}

/// Appends numbers with the most significant byte first, as PETSc's files have them.
template <class Number>
void append(std::string& bytes, Number number) {
  char raw[sizeof(Number)];
  std::memcpy(raw, &number, sizeof(Number));
  if constexpr (std::endian::native == std::endian::little) std::reverse(std::begin(raw), std::end(raw));
  bytes.append(raw, sizeof(Number));
}

/// A sparse matrix of PETSc: class, rows, columns, numbers; lengths of rows; columns; values.
path write_petsc(const Named& named, const path& folder) {
  constexpr std::int32_t matrix_class = 1211216;
  std::vector<std::int32_t> length(static_cast<std::size_t>(named.matrix.rows()), 0);
  std::string columns;
  std::string values;
  std::int64_t count = 0;
  for_each_number(named.matrix, [&](std::int64_t row, std::int64_t column, double value) {
    ++length[static_cast<std::size_t>(row)];
    ++count;
    append(columns, static_cast<std::int32_t>(column));
    append(values, value);
  });
  if (count > std::numeric_limits<std::int32_t>::max())
    throw InputError(
        fmt::format("{} has {} numbers, and files of PETSc count up to {}; write h5 or mtx instead",
                    named.name, count, std::numeric_limits<std::int32_t>::max()));
  std::string bytes;
  for (const std::int64_t head :
       {std::int64_t{matrix_class}, named.matrix.rows(), named.matrix.column_count(), count})
    append(bytes, static_cast<std::int32_t>(head));
  for (const std::int32_t numbers : length) append(bytes, numbers);
  return write(folder / (named.name + ".petsc"), bytes + columns + values);
}

/// A column of numbers of the elements.
template <class T, class Of>
std::vector<T> of_elements(const LinearSystem& system, const Of& of) {
  std::vector<T> result;
  for (const ContactElement& e : system.elements) result.push_back(of(e));
  return result;
}

path write_hdf5(const Model& model, const LinearSystem& system, const std::vector<Named>& matrices,
                const path& folder) {
  const path file = folder / "matrices.h5";
  AtomicFile part(file);
  const h5::Silence silence;
  try {
    std::size_t numbers = 100 * system.elements.size() + 20 * model.bodies.position.size() + 10000;
    for (const Named& named : matrices) numbers += 2 * named.matrix.values.size();
    h5::File hdf5 = h5::File::create_in_memory(sizeof(double) * numbers);
    hdf5.set("/", "format", std::string_view("eigengrain matrices 1"));
    for (const Named& named : matrices) {
      const std::string group = "/" + named.name;
      hdf5.add_group(group);
      hdf5.set(group, "what", std::string_view(named.what));
      hdf5.set(group, "rows", named.matrix.rows());
      hdf5.set(group, "columns", named.matrix.column_count());
      hdf5.write_rows(group + "/data", h5::Number::f64, named.matrix.values.data(),
                      named.matrix.columns.size(), block * block);
      hdf5.write(group + "/indices", named.matrix.columns);
      hdf5.write(group + "/indptr", named.matrix.offsets);
    }
    const assembly::Unknowns& unknowns = system.unknowns;
    std::vector<std::int64_t> ball;
    std::vector<std::int32_t> row;
    std::vector<std::int8_t> is_rotation;
    for (std::int32_t k = 0; k < unknowns.blocks(); ++k) {
      row.push_back(unknowns.body(k));
      ball.push_back(model.bodies.identity[static_cast<std::size_t>(unknowns.body(k))]);
      is_rotation.push_back(unknowns.is_rotation(k) ? 1 : 0);
    }
    hdf5.add_group("/unknowns");
    hdf5.write("/unknowns/ball", ball);
    hdf5.write("/unknowns/row", row);
    hdf5.write("/unknowns/is_rotation", is_rotation);
    hdf5.write("/unknowns/free", unknowns.free_components());
    hdf5.add_group("/elements");
    hdf5.write("/elements/a", of_elements<std::int32_t>(system, [](const ContactElement& e) { return e.a; }));
    hdf5.write("/elements/b", of_elements<std::int32_t>(system, [](const ContactElement& e) { return e.b; }));
    hdf5.write("/elements/normal",
               of_elements<Vec3>(system, [](const ContactElement& e) { return e.normal; }));
    hdf5.write("/elements/lever_a",
               of_elements<Vec3>(system, [](const ContactElement& e) { return e.lever_a; }));
    hdf5.write("/elements/lever_b",
               of_elements<Vec3>(system, [](const ContactElement& e) { return e.lever_b; }));
    hdf5.add_group("/bodies");
    hdf5.write("/bodies/identity", model.bodies.identity);
    hdf5.write("/bodies/position", model.bodies.position);
    hdf5.write("/bodies/radius", model.bodies.radius);
    const std::span<const char> image = hdf5.image();
    part.write({image.data(), image.size()});
  } catch (const h5::Error& error) {
    throw SolverError(fmt::format("{}: the matrices cannot be written: {}", file.string(), error.what()));
  }
  part.commit();
  return file;
}

std::string numbers(const Vec3& v) {
  return fmt::format("{:.17g},{:.17g},{:.17g}", v.x(), v.y(), v.z());
}

path write_contacts(const Model& model, const path& folder) {
  std::string text =
      "ball a,ball b,wall,image x,image y,image z,normal x,normal y,normal z,overlap [m],x [m],y [m],z [m],"
      "force x [N],force y [N],force z [N],slides,entry of contacts\n";
  const std::vector<std::int64_t>& identity = model.bodies.identity;
  for (const measures::ActingContact& c : measures::acting_contacts(model)) {
    const bool wall = c.b == measures::ActingContact::wall;
    fmt::format_to(std::back_inserter(text), "{},{},{},{},{},{},{},{:.17g},{},{},{},{}\n",
                   identity[static_cast<std::size_t>(c.ball_a)],
                   wall ? std::string() : fmt::format("{}", identity[static_cast<std::size_t>(c.ball_b)]),
                   wall ? fmt::format("{}", c.ball_b) : std::string(), c.image[0], c.image[1], c.image[2],
                   numbers(c.normal), c.overlap, numbers(c.point), numbers(c.force), c.slides ? 1 : 0,
                   c.rule);
  }
  return write(folder / "contacts.csv", text);
}

path write_bodies(const Model& model, const path& folder) {
  std::string text = "row,ball,x [m],y [m],z [m],radius [m],mass [kg],inertia [kg m2]\n";
  const model::Bodies& bodies = model.bodies;
  for (std::size_t row = 0; row < bodies.position.size(); ++row)
    fmt::format_to(std::back_inserter(text), "{},{},{},{:.17g},{:.17g},{:.17g}\n", row, bodies.identity[row],
                   numbers(bodies.position[row]), bodies.radius[row], bodies.mass[row], bodies.inertia[row]);
  return write(folder / "bodies.csv", text);
}

path write_unknowns(const Model& model, const LinearSystem& system, const path& folder) {
  std::string text = "unknown,ball,component,fixed,mass [kg or kg m2]\n";
  constexpr std::string_view name[] = {"ux", "uy", "uz", "tx", "ty", "tz"};
  for (std::int32_t k = 0; k < system.unknowns.blocks(); ++k)
    for (int i = 0; i < block; ++i)
      fmt::format_to(std::back_inserter(text), "{},{},{},{},{:.17g}\n", block * k + i,
                     model.bodies.identity[static_cast<std::size_t>(system.unknowns.body(k))],
                     name[i + (system.unknowns.is_rotation(k) ? block : 0)],
                     system.unknowns.is_fixed(k, i) ? 1 : 0,
                     system.mass[static_cast<std::size_t>(block * k + i)]);
  return write(folder / "unknowns.csv", text);
}

}  // namespace

MatrixFormat matrix_format(std::string_view name) {
  const auto found = std::ranges::find(matrix_format_names, name);
  if (found == std::end(matrix_format_names)) {
    const std::vector<std::string> known(std::begin(matrix_format_names), std::end(matrix_format_names));
    throw InputError(
        fmt::format("\"{}\" is no format of matrices{}; there are mtx (MatrixMarket), petsc, h5 and csv",
                    name, did_you_mean(std::string(name), known)));
  }
  return static_cast<MatrixFormat>(found - std::begin(matrix_format_names));
}

std::vector<path> export_matrices(const Model& model, const LinearSystem& system,
                                  std::span<const MatrixFormat> formats, const path& folder) {
  make_folder(folder);
  const bool only_tables =
      std::ranges::all_of(formats, [](MatrixFormat f) { return f == MatrixFormat::csv; });
  const std::vector<Named> matrices = only_tables ? std::vector<Named>{} : matrices_of(system);
  std::vector<path> files;
  for (const MatrixFormat format : formats) switch (format) {
      case MatrixFormat::matrix_market:
        for (const Named& named : matrices) files.push_back(write_matrix_market(named, folder));
        break;
      case MatrixFormat::petsc:
        for (const Named& named : matrices) files.push_back(write_petsc(named, folder));
        break;
      case MatrixFormat::hdf5:
        files.push_back(write_hdf5(model, system, matrices, folder));
        break;
      case MatrixFormat::csv:
        files.push_back(write_contacts(model, folder));
        files.push_back(write_bodies(model, folder));
        files.push_back(write_unknowns(model, system, folder));
        break;
    }
  return files;
}

}  // namespace eigengrain::io
