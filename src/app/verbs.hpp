#pragma once

#include <string>
#include <vector>

/// The verbs of the command line: one file each, verb_<name>.cpp.
namespace eigengrain::app {

/// What every verb takes.
struct Options {
  std::string scene;                   ///< file
  std::string json;                    ///< file for the result; empty: none
  std::vector<std::string> overrides;  ///< key=value
  std::string petsc;                   ///< options for PETSc
};

/// Each throws InputError or SolverError; whatever returns was a success.
void check(const Options& options);
void timestep(const Options& options);

}  // namespace eigengrain::app
