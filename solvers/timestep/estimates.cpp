#include "eigengrain/timestep/estimates.hpp"

#include "eigengrain/cycle/bounds.hpp"
#include "eigengrain/cycle/step_of.hpp"
#include "eigengrain/cycle/step_prover.hpp"

#include "timestep/estimates/contact_space.hpp"
#include "timestep/estimates/element_bounds.hpp"
#include "timestep/estimates/lanczos.hpp"
#include "timestep/estimates/matrix_bounds.hpp"
#include "timestep/estimates/rules.hpp"

#include <array>
#include <limits>

namespace eigengrain::timestep {
namespace {

using cycle::step_of;

/// Of the bounds that Lanczos' method proves but for chance.
constexpr double failure = 1e-6;
constexpr std::uint64_t seed = 1;

/// A rule or bound that asks for the system only.
template <double (*rule)(const assembly::LinearSystem&)>
Answer of_system(const Question& q) {
  return {.dt = rule(q.system)};
}

template <int sweeps>
Answer scaled_block(const Question& q) {
  return {.dt = cycle::scaled_block_bound(q.system, sweeps)};
}

/// Of the undamped system, as all rows are.
double raised_block(const assembly::LinearSystem& given) {
  assembly::LinearSystem system = given;
  system.damping.clear();
  system.nodal.viscous.clear();
  return cycle::StepProver(system).sharpen(std::numeric_limits<double>::infinity(), 1.015);
}

enum class Reading { ritz, residual, gap_free, probable };

template <Reading reading, int steps>
Answer of_lanczos(const Question& q) {
  if (q.system.unknowns.free_components().empty()) return {.dt = step_of(0)};
  const LanczosRun run = lanczos(q.system, steps, gaussian_start(q.system, seed));
  double lambda = run.ritz;
  if (reading == Reading::residual) lambda += run.residual;
  if (reading == Reading::gap_free) lambda = gap_free_bound(run, failure);
  if (reading == Reading::probable) lambda = probable_bound(run, failure);
  return {.dt = step_of(lambda), .products = static_cast<std::int64_t>(run.alpha.size())};
}

// One row an estimate; the table of docs/user-guide.md has the same rows.
constexpr std::array all{
    Estimator{.name = "diagonal",
              .source = "PFC3D 4.0, General Formulation, eq. 1.31 (eq. 1.35 with dashpots)",
              .find = of_system<cycle::diagonal_estimate>,
              .depends_on_frame = true,
              .knows_nodes = true},
    Estimator{.name = "diagonal-translation",
              .source = "PFC3D eq. 1.31, translations alone",
              .find = of_system<diagonal_of_translations>,
              .depends_on_frame = true,
              .knows_nodes = true},
    Estimator{.name = "diagonal-rotation",
              .source = "PFC3D eq. 1.31, rotations alone",
              .find = of_system<diagonal_of_rotations>,
              .depends_on_frame = true,
              .knows_nodes = true},
    Estimator{.name = "diagonal-turned",
              .source = "PFC3D eq. 1.31, mean over 100 random frames",
              .find = diagonal_of_turned_frames},
    Estimator{.name = "yade-global-stiffness",
              .source = "YADE, GlobalStiffnessTimeStepper, without its factor",
              .find = [](const Question& q) { return Answer{yade_global_stiffness(q)}; },
              .depends_on_frame = true},
    Estimator{.name = "nodal",
              .source = "sqrt(2 m / sum of kn); YADE, DEM formulation, stability",
              .find = of_system<nodal>},
    Estimator{.name = "mass-over-stiffness",
              .source = "sqrt(m_min/kn_max), the chain of PFC3D's eq. 1.30",
              .find = of_system<mass_over_stiffness>},
    Estimator{.name = "coordination",
              .source = "sqrt(2 m_min/(z_max kn_max)); after Otsubo, O'Sullivan and Shire 2017",
              .find = of_system<mass_over_stiffness_and_coordination>},
    Estimator{.name = "contact-duration",
              .source = "pi sqrt(m_min/kn_max), how long an impact takes",
              .find = of_system<contact_duration>},
    Estimator{.name = "reduced-duration",
              .source = "pi sqrt(m*/kn) of each contact, m* the reduced mass",
              .find = of_system<reduced_contact_duration>},
    Estimator{.name = "rayleigh",
              .source = "pi R sqrt(rho/G)/(0.1631 nu + 0.8766); LIGGGHTS, fix check/timestep/gran",
              .find = rayleigh},
    Estimator{.name = "p-wave", .source = "R sqrt(rho/E); YADE, PWaveTimeStep", .find = p_wave},
    Estimator{.name = "p-wave-of-stiffness",
              .source = "R sqrt(rho/E), E = kn/2R* as YADE makes kn of E",
              .find = p_wave_of_stiffness},
    Estimator{.name = "gershgorin",
              .source = "Gershgorin 1931, rows of M^-1 K in u and R theta",
              .claim = Claim::proven,
              .find =
                  [](const Question& q) {
                    return Answer{gershgorin_bound(ContactFactors(q.system), q.model.bodies)};
                  },
              .depends_on_frame = true},
    Estimator{
        .name = "gershgorin-symmetric",
        .source = "Gershgorin 1931, rows of M^-1/2 K M^-1/2",
        .claim = Claim::proven,
        .find =
            [](const Question& q) { return Answer{symmetric_gershgorin_bound(ContactFactors(q.system))}; },
        .depends_on_frame = true},
    Estimator{.name = "element-equal",
              .source = "Irons and Treharne 1971, Irons and Fried 1971; equal parts of the mass",
              .claim = Claim::proven,
              .find =
                  [](const Question& q) {
                    return Answer{element_bound(ContactFactors(q.system), MassSplit::equal)};
                  }},
    Estimator{.name = "element-stiffness",
              .source = "Irons and Treharne 1971, Irons and Fried 1971; parts of the mass by stiffness",
              .claim = Claim::proven,
              .find =
                  [](const Question& q) {
                    return Answer{element_bound(ContactFactors(q.system), MassSplit::by_stiffness)};
                  }},
    Estimator{
        .name = "element-best",
        .source = "Irons and Treharne 1971, Irons and Fried 1971; best parts of 30 sweeps (docs/theory.md)",
        .claim = Claim::proven,
        .find = [](const Question& q) { return Answer{best_element_bound(ContactFactors(q.system), 30)}; }},
    Estimator{.name = "block-bound",
              .source = "docs/theory.md, block bound",
              .claim = Claim::proven,
              .find = of_system<cycle::block_bound>,
              .knows_nodes = true},
    Estimator{.name = "scaled-block-bound",
              .source = "docs/theory.md, scaled block bound, 3 sweeps",
              .claim = Claim::proven,
              .find = scaled_block<3>,
              .knows_nodes = true},
    Estimator{.name = "scaled-block-bound-10",
              .source = "docs/theory.md, scaled block bound, 10 sweeps",
              .claim = Claim::proven,
              .find = scaled_block<10>,
              .knows_nodes = true},
    Estimator{.name = "raised-block-bound",
              .source = "docs/theory.md, raising where needed, until 1.5% more cannot be proven",
              .claim = Claim::proven,
              .find = of_system<raised_block>,
              .knows_nodes = true},
    Estimator{
        .name = "contact-space",
        .source = "docs/theory.md, block Gershgorin of the contact-space matrix",
        .claim = Claim::proven,
        .find = [](const Question& q) { return Answer{contact_space_bound(ContactFactors(q.system), 0)}; }},
    Estimator{
        .name = "contact-space-scaled",
        .source = "docs/theory.md, block Gershgorin of the contact-space matrix, 10 sweeps of weights",
        .claim = Claim::proven,
        .find = [](const Question& q) { return Answer{contact_space_bound(ContactFactors(q.system), 10)}; }},
    Estimator{.name = "lanczos-10",
              .source = "Lanczos 1950, largest Ritz value of 10 steps",
              .find = of_lanczos<Reading::ritz, 10>,
              .knows_nodes = true},
    Estimator{.name = "lanczos-20",
              .source = "Lanczos 1950, largest Ritz value of 20 steps",
              .find = of_lanczos<Reading::ritz, 20>,
              .knows_nodes = true},
    Estimator{.name = "lanczos-40",
              .source = "Lanczos 1950, largest Ritz value of 40 steps",
              .find = of_lanczos<Reading::ritz, 40>,
              .knows_nodes = true},
    Estimator{.name = "lanczos-residual-10",
              .source = "Ritz value and residual of 10 Lanczos steps: another eigenvalue may be larger",
              .find = of_lanczos<Reading::residual, 10>,
              .knows_nodes = true},
    Estimator{.name = "lanczos-residual-20",
              .source = "Ritz value and residual of 20 Lanczos steps",
              .find = of_lanczos<Reading::residual, 20>,
              .knows_nodes = true},
    Estimator{.name = "lanczos-residual-40",
              .source = "Ritz value and residual of 40 Lanczos steps",
              .find = of_lanczos<Reading::residual, 40>,
              .knows_nodes = true},
    Estimator{.name = "lanczos-gap-free-20",
              .source = "Kuczynski and Wozniakowski 1992, 20 steps",
              .claim = Claim::probable,
              .find = of_lanczos<Reading::gap_free, 20>,
              .failure = failure,
              .knows_nodes = true},
    Estimator{.name = "lanczos-gap-free-40",
              .source = "Kuczynski and Wozniakowski 1992, 40 steps",
              .claim = Claim::probable,
              .find = of_lanczos<Reading::gap_free, 40>,
              .failure = failure,
              .knows_nodes = true},
    Estimator{.name = "lanczos-probable-10",
              .source = "van Dorsselaer, Hochstenbach and van der Vorst 2000, Lanczos polynomial, 10 steps",
              .claim = Claim::probable,
              .find = of_lanczos<Reading::probable, 10>,
              .failure = failure,
              .knows_nodes = true},
    Estimator{.name = "lanczos-probable-20",
              .source = "van Dorsselaer, Hochstenbach and van der Vorst 2000, Lanczos polynomial, 20 steps",
              .claim = Claim::probable,
              .find = of_lanczos<Reading::probable, 20>,
              .failure = failure,
              .knows_nodes = true},
    Estimator{.name = "lanczos-probable-40",
              .source = "van Dorsselaer, Hochstenbach and van der Vorst 2000, Lanczos polynomial, 40 steps",
              .claim = Claim::probable,
              .find = of_lanczos<Reading::probable, 40>,
              .failure = failure,
              .knows_nodes = true},
};

}  // namespace

std::string_view name_of(Claim claim) {
  switch (claim) {
    case Claim::none:
      return "none";
    case Claim::probable:
      return "probable";
    case Claim::proven:
      break;
  }
  return "proven";
}

std::span<const Estimator> estimators() {
  return all;
}

const Estimator* find_estimator(std::string_view name) {
  for (const Estimator& estimator : all)
    if (estimator.name == name) return &estimator;
  return nullptr;
}

}  // namespace eigengrain::timestep
