// The assembled matrix, and the matrix-free product against it on the same K.
#include "eigengrain/assembly/product.hpp"
#include "eigengrain/assembly/stiffness.hpp"

#include "bench/measure.hpp"
#include "bench/packings.hpp"
#include "petsc/error.hpp"
#include "petsc/stiffness_matrix.hpp"

#include <benchmark/benchmark.h>

namespace eigengrain::bench {
namespace {

void assemble(petsc::StiffnessMatrix& matrix, const Packing& p) {
  matrix.begin();
  assembly::assemble_stiffness(p.model, matrix);
  matrix.end();
}

void matrix_pattern(benchmark::State& state) {
  const Packing& p = packing(state.range(0));
  time_each(state, Threads(), [&] {
    const petsc::StiffnessMatrix matrix(p.unknowns, p.elements);
    benchmark::DoNotOptimize(matrix.mat());
  });
  state.counters["s_per_contact"] = seconds_for_each(static_cast<double>(p.contacts()));
}
BENCHMARK(matrix_pattern)->Apply(sizes);

/// What a product with the assembled matrix streams: block values and column numbers.
double matrix_bytes(Mat mat) {
  MatInfo info;
  EIGENGRAIN_PETSC(MatGetInfo(mat, MAT_LOCAL, &info));
  constexpr double block = 9 * sizeof(PetscScalar) + sizeof(PetscInt);
  return info.nz_used / 9 * block;
}

/// In units of products with the matrix that it fills, measured by turns.
void matrix_assembly(benchmark::State& state) {
  const Packing& p = packing(state.range(0));
  const Threads threads;
  petsc::StiffnessMatrix matrix(p.unknowns, p.elements);
  assemble(matrix, p);
  petsc::Vector x;
  petsc::Vector y;
  EIGENGRAIN_PETSC(MatCreateVecs(matrix.mat(), x.put(), y.put()));
  EIGENGRAIN_PETSC(VecSet(x.get(), 1.0));
  SideBySide times;
  for ([[maybe_unused]] auto _ : state) {
    const double product =
        seconds_a_call(threads, [&] { EIGENGRAIN_PETSC(MatMult(matrix.mat(), x.get(), y.get())); });
    const double assembly = threads.seconds([&] { assemble(matrix, p); });
    times.add(product, assembly);
    state.SetIterationTime(assembly);
  }
  const auto contacts = static_cast<double>(p.contacts());
  state.counters["s_per_contact"] = times.second() / contacts;
  state.counters["matrix_products"] = times.second_over_first();
}
BENCHMARK(matrix_assembly)->Apply(sizes)->Iterations(5);

/// K x without and with the matrix, by turns, in one run. PETSc's product has one thread.
void product_against_matrix(benchmark::State& state) {
  const Packing& p = packing(state.range(0));
  const Threads threads(state.range(1));
  assembly::StiffnessProduct product(p.unknowns, p.elements);
  petsc::StiffnessMatrix matrix(p.unknowns, p.elements);
  assemble(matrix, p);

  const std::vector<double> numbers = random_numbers(product.size());
  std::vector<double> result(numbers.size());
  petsc::Vector x;
  petsc::Vector y;
  EIGENGRAIN_PETSC(MatCreateVecs(matrix.mat(), x.put(), y.put()));
  for (std::size_t i = 0; i < numbers.size(); ++i)
    EIGENGRAIN_PETSC(VecSetValue(x.get(), static_cast<PetscInt>(i), numbers[i], INSERT_VALUES));

  SideBySide times;
  for ([[maybe_unused]] auto _ : state) {
    const double without = seconds_a_call(threads, [&] { product.apply(numbers, result); });
    times.add(without,
              seconds_a_call(threads, [&] { EIGENGRAIN_PETSC(MatMult(matrix.mat(), x.get(), y.get())); }));
    state.SetIterationTime(without);
  }

  const auto contacts = static_cast<double>(p.contacts());
  state.counters["product_s_per_contact"] = times.first() / contacts;
  state.counters["matrix_s_per_contact"] = times.second() / contacts;
  state.counters["matrix_over_product"] = times.second_over_first();
  state.counters["product_bytes_per_contact"] = static_cast<double>(product.record_bytes()) / contacts;
  state.counters["matrix_bytes_per_contact"] = matrix_bytes(matrix.mat()) / contacts;
}
BENCHMARK(product_against_matrix)->Apply(sizes_and_threads)->Iterations(11);

}  // namespace
}  // namespace eigengrain::bench
