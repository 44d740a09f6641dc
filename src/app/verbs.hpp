#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

/// The verbs of the command line: one file each, verb_<name>.cpp.
namespace eigengrain::app {

/// What modes and rigidity are asked for.
struct SpectrumOptions {
  int lowest = 10;                ///< how many
  int highest = 10;               ///< how many
  bool all = false;               ///< every mode there is
  bool density = false;           ///< density of states by random vectors
  int moments = 512;              ///< of it
  int vectors = 8;                ///< of it
  int bins = 50;                  ///< of it
  std::string springs = "all";    ///< of rigidity
  bool without_rattlers = false;  ///< of rigidity
};

/// What every verb takes.
struct Options {
  std::string scene;                   ///< file
  std::string json;                    ///< file for the result; empty: none
  std::vector<std::string> overrides;  ///< key=value
  std::string petsc;                   ///< options for PETSc
  std::vector<std::string> regions;    ///< of measure: instead of those of the scene
  std::string output;                  ///< folder of results; empty: see read_input. Of generate: a file
  double tolerance = 1e-10;            ///< of relax: mean unbalanced ratio
  std::int64_t max_steps = 1000000;    ///< of relax: explicit steps
  std::string method = "hybrid";       ///< of relax: by name
  std::vector<std::string> loads;      ///< of relax: a loading path; empty: none
  int increments = 10;                 ///< of relax: of that path
  bool continues = false;              ///< of relax: behind the last state of that path
  std::string against;                 ///< of relax: the method to compare the end with; empty: none
  bool tangent = false;                ///< of timestep: what the elastic stiffness leaves out
  bool certify = false;                ///< of timestep: prove the truth at any size
  bool empirical = false;              ///< of timestep: the limit by running, too
  std::string page;                    ///< of compare: file of the report; empty: none
  std::vector<std::string> scenes;     ///< of compare timesteps and relaxation: files and folders
  std::vector<std::int64_t> sizes;     ///< of compare timesteps: numbers of balls to measure costs at
  std::vector<double> fractions;       ///< of compare steps: of the limit; empty: the usual ones
  double time = 0;                     ///< of compare steps, s; 0: that of the scene
  int modes = 0;                       ///< of timestep: how many of the modes that limit the step; 0: none
  std::string modes_file;              ///< of timestep: their shapes; empty: none
  std::optional<double> lift;          ///< of timestep: the step that masses are to make stable, s
  SpectrumOptions spectrum;            ///< of modes and rigidity
  std::vector<std::string> formats;    ///< of export
};

/// Each throws InputError, SolverError or Interrupted; whatever returns was a success.
void check(const Options& options);
void generate(const Options& options);
void measure(const Options& options);
void timestep(const Options& options);
void run(const Options& options);
void relax(const Options& options);
void modes(const Options& options);
void rigidity(const Options& options);
void moduli(const Options& options);
void export_matrices(const Options& options);
/// `compare` takes a subject: a verb of its own, with a page of its own.
void compare_timesteps(const Options& options);
void compare_steps(const Options& options);
void compare_relaxation(const Options& options);

}  // namespace eigengrain::app
