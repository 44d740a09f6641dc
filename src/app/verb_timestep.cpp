#include "eigengrain/assembly/local_damping.hpp"
#include "eigengrain/base/error.hpp"
#include "eigengrain/cycle/mass_scaling.hpp"
#include "eigengrain/cycle/policy.hpp"
#include "eigengrain/petsc/session.hpp"
#include "eigengrain/timestep/comparison.hpp"
#include "eigengrain/timestep/empirical_limit.hpp"
#include "eigengrain/timestep/tangent_spectrum.hpp"

#include "comparison_json.hpp"
#include "input.hpp"
#include "step_limits.hpp"
#include "text.hpp"
#include "verbs.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <optional>
#include <string>
#include <utility>

namespace eigengrain::app {
namespace {

using nlohmann::ordered_json;
using timestep::Comparison;
using timestep::Estimate;

/// The step that a run would take next.
struct PolicyStep {
  std::string how;
  double dt = 0;
};

PolicyStep policy_step(const assembly::State& state) {
  const model::TimestepChoice& choice = state.settings.timestep;
  std::string how = "fixed";
  if (state.settings.mass_scaling)
    how = fmt::format("mass scaling: {:g} of what is proven for all near pairs", choice.safety);
  else if (choice.policy == model::TimestepPolicy::bound)
    how = fmt::format("bound: {:g} of what is proven for all near pairs", choice.safety);
  else if (choice.policy == model::TimestepPolicy::tracked)
    how = fmt::format("tracked: {:g} of what is proven for the contacts and what is about to touch",
                      choice.safety);
  else if (choice.policy == model::TimestepPolicy::estimate)
    how = fmt::format("estimate: {:g} of diagonal", choice.safety);
  // A run that goes on has its step already.
  const double dt = state.next_dt > 0 ? state.next_dt : cycle::policy_of(state.settings).dt(state);
  return {std::move(how), dt};
}

ordered_json to_json(const Comparison& c, const PolicyStep& policy) {
  ordered_json report = comparison_json(c);
  report["policy"] = {{"dt", json_number(policy.dt)},
                      {"ratio_to_limit", json_number(policy.dt / c.truth.limit)},
                      {"safe", policy.dt <= c.truth.limit}};
  return report;
}

ordered_json to_json(const timestep::Eigenvalue& e, double dt) {
  if (!e.found()) return nullptr;
  return {{"real", e.value.real()},
          {"imaginary", e.value.imag()},
          {"residual", e.residual},
          {"growth_per_step", timestep::growth_per_step(e.value, dt)}};
}

ordered_json to_json(const timestep::SpectrumEnds& ends, double dt) {
  return {{"largest", to_json(ends.largest, dt)}, {"least", to_json(ends.least, dt)}};
}

/// growth is that of the step which the policy would take.
ordered_json to_json(const timestep::TangentSpectrum& t, double dt) {
  return {{"contacts", t.contacts},
          {"sliding", t.sliding},
          {"elastic", to_json(t.elastic, dt)},
          {"sticking", to_json(t.sticking, dt)},
          {"slipping", to_json(t.slipping, dt)},
          {"widest", to_json(t.widest, dt)},
          {"complex_pairs", t.complex_pairs < 0 ? ordered_json(nullptr) : ordered_json(t.complex_pairs)},
          {"seconds", t.seconds}};
}

std::string text_of(const timestep::Eigenvalue& e) {
  if (!e.found()) return "not found";
  if (e.value.imag() == 0) return fmt::format("{:.6e}", e.value.real());
  return fmt::format("{:.6e} +- {:.2e} i", e.value.real(), e.value.imag());
}

void print(const timestep::TangentSpectrum& t, double dt) {
  fmt::print("\n{:<34} {:>26} {:>12} {:>26}\n", "eigenvalues of M^-1 T [1/s2]", "largest", "of elastic",
             "least");
  const double elastic = t.elastic.largest.value.real();
  const auto line = [&](const std::string& what, const timestep::SpectrumEnds& ends) {
    fmt::print("{:<34} {:>26} {:>12.6f} {:>26}\n", what, text_of(ends.largest),
               ends.largest.value.real() / elastic, text_of(ends.least));
  };
  line("elastic (K)", t.elastic);
  line("with present forces, all stick", t.sticking);
  line(fmt::format("{} of {} contacts slip", t.sliding, t.contacts), t.slipping);
  if (t.complex_pairs > 0 || (t.widest.found() && t.widest.value.imag() > 0))
    fmt::print("flutter: {}the widest pair {} grows by {:.3g} a step of {:.3e} s, and by some at any other\n",
               t.complex_pairs > 0 ? counted(t.complex_pairs, "complex pair, ", "complex pairs, ") : "",
               text_of(t.widest), timestep::growth_per_step(t.widest.value, dt), dt);
  const timestep::Eigenvalue& least = t.slipping.least;
  if (least.found() && least.value.real() < -1e-9 * elastic)
    fmt::print("negative stiffness: {} grows by {:.3g} a step of {:.3e} s, and by some at any other\n",
               text_of(least), timestep::growth_per_step(least.value, dt), dt);
}

void print_policy(const PolicyStep& policy, const Comparison& c) {
  const double ratio = policy.dt / c.truth.limit;
  fmt::print("\nStep of this scene ({}): {:.6e} s, {:.4f} of the limit.\n", policy.how, policy.dt, ratio);
  if (ratio > 1)
    fmt::print(
        "WARNING: that is above the limit; the cycle will blow up. Take at most {:.6e} s, or "
        "timestep: {{policy: bound}}.\n",
        c.truth.limit);
}

ordered_json to_json(const timestep::EmpiricalLimit& found, const timestep::Truth& truth) {
  return {{"dt", json_number(found.dt)},
          {"stable", json_number(found.stable)},
          {"growing", json_number(found.growing)},
          {"ratio_to_true", json_number(found.dt / truth.dt)},
          {"ratio_to_limit", json_number(found.dt / truth.limit)},
          {"linear", found.linear()},
          {"reservations", found.reservations},
          {"runs", found.runs},
          {"steps", found.steps},
          {"seconds", found.seconds}};
}

void print(const timestep::EmpiricalLimit& found, const timestep::Truth& truth) {
  fmt::print("\nBy running ({}, {} steps): motions grow above {:.6e} s, {:.4f} of the limit.\n",
             counted(found.runs, "run", "runs"), found.steps, found.dt, found.dt / truth.limit);
  for (const std::string& reservation : found.reservations)
    fmt::print("  of this state only: {}\n", reservation);
}

/// What the limit of the cycle counts with.
std::string damping_text(const assembly::Model& model) {
  const double alpha = assembly::largest_damping(model);
  const bool dashpots = assembly::has_dashpots(model);
  const char* const beside = dashpots ? " and dashpots" : "";
  if (alpha == 0) return dashpots ? "with dashpots" : "undamped";
  return model.bodies.damping.empty()
             ? fmt::format("with local damping {:g}{}", alpha, beside)
             : fmt::format("with the local damping of each body, at most {:g}{}", alpha, beside);
}

/// What is to be thought of an estimate.
std::string verdict(const Estimate& e) {
  if (!e.safe) return "UNSAFE";
  if (e.claim == timestep::Claim::proven) return "safe (proven)";
  if (e.claim == timestep::Claim::probable) return fmt::format("safe (but for {:.0e})", e.failure);
  return e.range ? fmt::format("{:.4f} to {:.4f}", e.range->least / e.dt * e.ratio_to_true,
                               e.range->largest / e.dt * e.ratio_to_true)
                 : "safe here";
}

void print(const assembly::State& state, const Comparison& c, const PolicyStep& policy) {
  const model::Scene& scene = state.settings;
  fmt::print("{}: {}, {}, {}\n", scene.name, counted(c.bodies, "ball", "balls"),
             counted(c.contacts, "acting contact", "acting contacts"),
             counted(c.unknowns, "unknown", "unknowns"));
  print_notes(scene);
  if (scene.mass_scaling)
    fmt::print("masses are scaled: all that follows is of the scaled system, not of the true one\n");
  if (c.set_aside > 0)
    fmt::print("set aside: {} without acting contacts\n", counted(c.set_aside, "ball", "balls"));
  if (c.unknowns == 0 || !std::isfinite(c.truth.dt)) {
    fmt::print("\nNothing resists a motion here, so no timestep is critical.\n");
    return;
  }
  fmt::print("\n{:<22} {:>14} {:>9}  {:<22} {:>9} {:>9}\n", "critical timestep", "dt [s]", "of true", "",
             "seconds", "products");
  fmt::print("{:<22} {:>14.8e} {:>9.4f}  {:<22} {:>9.2g} {:>9}\n", "true", c.truth.dt, 1.0,
             fmt::format("residual {:.1e}{}", c.truth.residual, c.truth.certified ? ", proven" : ""),
             c.truth.seconds, c.truth.products);
  for (const Estimate& e : c.estimates)
    fmt::print("{:<22} {:>14.8e} {:>9.4f}  {:<22} {:>9.2g} {:>9}\n", e.name, e.dt, e.ratio_to_true,
               verdict(e), e.seconds, e.products);
  for (const timestep::LeftOut& none : c.left_out) fmt::print("{:<22} none: {}\n", none.name, none.reason);
  fmt::print("{:<22} {:>14.8e} {:>9.4f}  {}\n", "limit of the cycle", c.truth.limit,
             c.truth.limit / c.truth.dt, damping_text(state.model));
  print_policy(policy, c);
}

}  // namespace

void timestep(const Options& options) {
  if (!options.petsc.empty()) petsc::set_options(options.petsc);
  assembly::State state = read_input(options).state;
  if (state.settings.mass_scaling && state.next_dt == 0) cycle::scale_masses(state);
  if (options.lift && state.settings.mass_scaling)
    throw InputError(
        "--lift: beside mass_scaling, which chooses masses itself; add --set mass_scaling.form=none, or "
        "leave "
        "--lift out");
  petsc::start();  // before the clocks of the comparison
  timestep::TruthOptions truth;
  if (options.certify) truth.certify = timestep::Certify::always;
  const Comparison comparison = timestep::compare(state.model, truth, state.settings.materials);
  const PolicyStep policy = policy_step(state);
  ordered_json report = to_json(comparison, policy);
  if (const auto& scaling = state.settings.mass_scaling)
    report["mass_scaling"] = model::name_of(scaling->form);
  std::optional<timestep::TangentSpectrum> tangent;
  if (options.tangent) {
    tangent = timestep::tangent_spectrum(state.model);
    report["tangent"] = to_json(*tangent, policy.dt);
  }
  std::optional<timestep::EmpiricalLimit> empirical;
  if (options.empirical && std::isfinite(comparison.truth.dt)) {
    empirical = timestep::empirical_limit(state, comparison.truth);
    report["empirical"] = to_json(*empirical, comparison.truth);
  }
  std::optional<timestep::LimitingModes> limits;
  if (options.modes > 0) {
    limits = timestep::limiting_modes(state.model, options.modes, truth);
    report["limits"] = to_json(*limits, state.model);
    if (!options.modes_file.empty()) write_modes(options.modes_file, *limits, state.model);
  }
  std::optional<timestep::SelectiveLift> lift;
  if (options.lift) {
    lift = timestep::lift_step(state.model, *options.lift, truth);
    report["lift"] = to_json(*lift, state.model);
  }
  if (!options.petsc.empty()) petsc::require_options_used();
  write_json(options.json, report);
  print(state, comparison, policy);
  if (tangent && comparison.unknowns > 0) print(*tangent, policy.dt);
  if (empirical) print(*empirical, comparison.truth);
  if (limits) print(*limits, state.model);
  if (lift) print(*lift);
}

}  // namespace eigengrain::app
