#pragma once

#include "eigengrain/timestep/estimates.hpp"

/// Rules of thumb of papers and codes: sums over the contacts of a body, or one mass and one stiffness. None
/// is a bound. All steps in s, before any safety factor, for a system without dashpots.
namespace eigengrain::timestep {

/// PFC3D's eq. 1.31 for translations or rotations alone, s: min √(m/k).
double diagonal_of_translations(const assembly::LinearSystem& system);
double diagonal_of_rotations(const assembly::LinearSystem& system);

/// The same for all, over random orientations of the frame: dt is the mean. The scene itself is not turned,
/// its 6×6 blocks are. Left out where components are fixed, as those are along the axes of the scene.
Answer diagonal_of_turned_frames(const Question& question);

/// YADE's GlobalStiffnessTimeStepper, with its 1.41044 for √2 and without its timestepSafetyCoefficient:
///
///   1.41044 min √(m / max_a K_a), √(I_a/R_a)    K_a = Σ (k_n - k_s) n_a² + k_s,  R_a = Σ k_s r² (1 - n_a²)
///
/// r the radius of the ball. Moments of bonds are not counted, and clumps sum K and R of their balls without
/// the arms of these. YADE itself leaves out contacts whose normal force is zero.
double yade_global_stiffness(const Question& question);

/// min √(2 m / Σ k_n) over bodies: the spring's other end moves as much the other way (YADE, DEM formulation,
/// stability considerations).
double nodal(const assembly::LinearSystem& system);

/// √(m_min/k_max), masses of bodies with contacts, k_max the stiffest spring along n (Cundall and Strack
/// 1979).
double mass_over_stiffness(const assembly::LinearSystem& system);
/// The same over √(z/2), z the largest number of contacts of a body: the parameters of Otsubo, O'Sullivan and
/// Shire 2017, with the factor that makes it exact for a chain (z = 2).
double mass_over_stiffness_and_coordination(const assembly::LinearSystem& system);

/// π √(m_min/k_max): as long as a linear impact takes.
double contact_duration(const assembly::LinearSystem& system);
/// min π √(m*/k_n) over contacts, m* the reduced mass.
double reduced_contact_duration(const assembly::LinearSystem& system);

/// min π R √(ρ/G)/(0.1631 ν + 0.8766) over balls: time of a Rayleigh wave (LIGGGHTS, fix
/// check/timestep/gran).
Answer rayleigh(const Question& question);
/// min R √(ρ/E) over balls (YADE, utils.PWaveTimeStep).
Answer p_wave(const Question& question);
/// The same with the modulus from which YADE would make the stiffest contact of the ball, k_n = 2 E R*. Left
/// out with clumps and disks.
Answer p_wave_of_stiffness(const Question& question);

}  // namespace eigengrain::timestep
