#pragma once

#include "eigengrain/contact/dissipation.hpp"

#include <array>
#include <string_view>

/// What an energy ledger carries from step to step. What it says is in measures/ledger.hpp.
namespace eigengrain::assembly {

/// Energy that went in and out, summed over the steps since the ledger began, J.
struct EnergyIntegrals {
  double gravity = 0;     ///< work of gravity on all bodies
  double applied = 0;     ///< work of forces and moments that are applied to bodies
  double growth = 0;      ///< what changing radii add to elastic and kinetic energy
  double prescribed = 0;  ///< work of whatever makes fixed components keep their velocity
  double walls = 0;       ///< work of walls that move
  double damping = 0;     ///< taken by local damping
  contact::Dissipation contacts{};

  EnergyIntegrals& operator+=(const EnergyIntegrals& other) {
    gravity += other.gravity;
    applied += other.applied;
    growth += other.growth;
    prescribed += other.prescribed;
    walls += other.walls;
    damping += other.damping;
    contacts += other.contacts;
    return *this;
  }
};

/// One of the integrals as files name it.
struct EnergyIntegral {
  std::string_view name;
  double sign = 0;  ///< +1: brings mechanical energy in, -1: takes it out
  double& (*in)(EnergyIntegrals& integrals) = nullptr;

  double of(EnergyIntegrals integrals) const { return in(integrals); }
};

/// All integrals: balance, state files, tables and JSON go through this list.
inline constexpr std::array<EnergyIntegral, 11> energy_integrals{{
    {"gravity_work", +1, [](EnergyIntegrals& all) -> double& { return all.gravity; }},
    {"applied_work", +1, [](EnergyIntegrals& all) -> double& { return all.applied; }},
    {"growth_work", +1, [](EnergyIntegrals& all) -> double& { return all.growth; }},
    {"prescribed_work", +1, [](EnergyIntegrals& all) -> double& { return all.prescribed; }},
    {"wall_work", +1, [](EnergyIntegrals& all) -> double& { return all.walls; }},
    {"slip_loss", -1, [](EnergyIntegrals& all) -> double& { return all.contacts.slip; }},
    {"rolling_loss", -1, [](EnergyIntegrals& all) -> double& { return all.contacts.rolling; }},
    {"viscous_loss", -1, [](EnergyIntegrals& all) -> double& { return all.contacts.viscous; }},
    {"hysteresis_loss", -1, [](EnergyIntegrals& all) -> double& { return all.contacts.hysteresis; }},
    {"bond_loss", -1, [](EnergyIntegrals& all) -> double& { return all.contacts.bonds; }},
    {"damping_loss", -1, [](EnergyIntegrals& all) -> double& { return all.damping; }},
}};

/// Of work over a step, each half counts with the force at its own end (trapezoidal rule): the integrals hold
/// all halves up to the forward one of the last step, whose backward one is known with the forces at its end.
struct EnergyLedger {
  double initial = 0;  ///< kinetic and elastic energy when it began, J
  EnergyIntegrals integrals{};
};

}  // namespace eigengrain::assembly
