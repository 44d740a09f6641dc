#pragma once

#include "eigengrain/assembly/linear_system.hpp"
#include "eigengrain/assembly/state.hpp"
#include "eigengrain/contact/law.hpp"
#include "eigengrain/model/scene.hpp"

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace eigengrain::cycle {

/// What a head-on contact of a ball with a wall, or a ball that is far larger, is like when it has stored an
/// energy (or at the typical overlap, where that stores more).
struct HeadOn {
  contact::ContactStiffness stiffness;
  contact::DampingRatios beta;
};

/// radius in m, energy in J.
HeadOn head_on(const model::ContactRule& rule, std::int32_t index, double radius, double energy = 0);

/// The steps that the first contact of a body allows, s.
struct FirstContact {
  /// √(m/k), √(I/k) of the degrees of freedom apart, k over F(β)² of dashpots
  double estimate = std::numeric_limits<double>::infinity();
  /// of the body's block, local damping and dashpots included: proven
  double bound = std::numeric_limits<double>::infinity();
};

/// No ball of a state meets another or a wall faster, m/s.
double fastest_approach(const assembly::State& state);

/// Of bodies (rows; holders of clumps) that touch nothing yet, for any head-on contact that the rules of the
/// scene allow, at a velocity (m/s); of clumps, wherever on their surface it may be.
FirstContact first_contact(const assembly::State& state, std::span<const std::int32_t> bodies,
                           double approach);

/// Whether stiffnesses follow the overlap, so that a step has to be asked for while nothing opens or closes.
bool stiffness_varies(const model::Scene& settings);

/// Bodies (rows; holders of clumps) that are judged by the contact that they may form next: those without
/// listed pairs, or where stiffness varies without acting contacts, as a near pair is listed with that of a
/// typical overlap.
///
/// listed  the system of all listed pairs
std::vector<std::int32_t> bodies_apart(const assembly::State& state, const assembly::LinearSystem& listed,
                                       bool varies);

}  // namespace eigengrain::cycle
