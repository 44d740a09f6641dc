#pragma once

/// Whether a sparse factor fits into memory, asked before it is made.
namespace eigengrain::timestep {

/// Throws SolverError where a factor of so many numbers does not fit into so many bytes.
///
/// what  asks for it, and `instead` what the user may do
void require_memory(
    double numbers, double available, const char* what = "the proof",
    const char* instead = "do without it (no --certify), or prove the scene on a larger machine");

/// Bytes that the machine can give without swapping; infinite where it does not say.
double available_memory();

}  // namespace eigengrain::timestep
