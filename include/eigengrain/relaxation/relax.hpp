#pragma once

#include "eigengrain/assembly/balance.hpp"
#include "eigengrain/assembly/state.hpp"

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

/// Quasi-static equilibrium.
namespace eigengrain::relaxation {

/// Ways to an equilibrium.
enum class Method : std::uint8_t {
  hybrid,          ///< tracked cycles until the contacts have settled, then Newton's method
  explicit_cycle,  ///< cycles with 0.8 of PFC3D's estimate of the step
  tracked,         ///< cycles with the tracked step
  scaled,          ///< cycles with masses scaled body by body (PFC3D 1.7)
  fire,            ///< FIRE, with the same masses
  newton           ///< Newton's method alone
};
struct NamedMethod {
  Method method;
  std::string_view name;
};
inline constexpr std::array methods{
    NamedMethod{Method::hybrid, "hybrid"},   NamedMethod{Method::explicit_cycle, "explicit"},
    NamedMethod{Method::tracked, "tracked"}, NamedMethod{Method::scaled, "scaled"},
    NamedMethod{Method::fire, "fire"},       NamedMethod{Method::newton, "newton"}};
constexpr std::string_view name_of(Method method) {
  return methods[static_cast<std::size_t>(method)].name;
}
/// None where no method has this name.
std::optional<Method> find_method(std::string_view name);

/// How far a relaxation is at a moment.
struct Moment {
  double seconds = 0;  ///< since the start
  std::int64_t sweeps =
      0;                   ///< over the contacts: a step, a residual and a product with a matrix are one each
  double mean = 0;         ///< the larger mean unbalanced ratio, of forces or moments
  double max = 0;          ///< the same of the largest; 0 within Newton's method
  std::string_view stage;  ///< what led there
};

struct RelaxOptions {
  double tolerance = 1e-10;          ///< mean unbalanced ratio wished for
  std::int64_t max_steps = 1000000;  ///< explicit ones and those of FIRE, those of parts included
  Method method = Method::hybrid;
  /// Called after every stage and every thousand explicit steps with a line to print; may be empty.
  std::function<void(const std::string&)> report{};
  /// Asked between stages, every hundred explicit steps, and within linear solvers: whether to give up; may
  /// be empty.
  std::function<bool()> interrupted{};
  /// Called with the state every hundred steps and after every stage; may be empty.
  std::function<void(const assembly::State&, const Moment&)> observe{};
};

/// A part of the way: all of one kind that came one after the other.
struct RelaxStage {
  std::string_view name;
  std::int64_t steps = 0;  ///< of the cycle or of FIRE
  int iterations = 0;      ///< of Newton's method
  int linear_iterations = 0;
  double seconds = 0;
  double mean = 0;  ///< ratio at its end
};

/// Bodies that touch each other and nothing that would hold them against their loads.
struct Floating {
  std::int64_t bodies = 0;
  std::int64_t first = 0;  ///< identity of one of them
};

struct RelaxResult {
  bool converged = false;
  std::string method;  ///< e.g. "newton" or "tracked+newton": what the end came from
  std::int64_t explicit_steps = 0;
  std::int64_t part_steps = 0;  ///< cycles of a few moving bodies by themselves
  int newton_iterations = 0;    ///< failed attempts included
  int linear_iterations = 0;
  int attempts = 0;  ///< of Newton's method
  std::vector<RelaxStage> stages;
  std::vector<Moment> course;                ///< every hundred steps, and every iteration of Newton's method
  std::string linear_method;                 ///< that solved Newton's last system
  std::vector<std::string> linear_failures;  ///< of solvers that broke down, after which others took over
  std::vector<Floating> floating;            ///< at the end, where there is no equilibrium; the largest first
  assembly::Balance start;
  assembly::Balance end;     ///< as the explicit cycle evaluates it
  double missing_force = 0;  ///< at the end: of a servo wall, the largest, as a part of its wanted force
  double seconds = 0;
  double explicit_seconds = 0;
};

/// Brings a state to the equilibrium nearest to where the damped motion leads. By default (hybrid): explicit
/// cycles with local damping 0.7 at the tracked step until nothing is unsupported and contacts have settled,
/// then Newton's method on the same contact law. Where only a few bodies still roll or fall, they and their
/// neighbours are cycled by themselves while the others wait. Where Newton fails, explicit cycles go on to a
/// tenth of the ratio. The state is then at rest, with its clock where it was: the explicit cycle continues
/// from it.
///
/// Friction admits many equilibria; this is one of them (docs/theory.md). Throws SolverError where PETSc
/// fails, where something is not a number, and where a run blows up; the state is then the last good one.
RelaxResult relax(assembly::State& state, const RelaxOptions& options = {});

}  // namespace eigengrain::relaxation
