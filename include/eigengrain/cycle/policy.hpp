#pragma once

#include "eigengrain/cycle/cycle.hpp"

namespace eigengrain::cycle {

/// The policies of scene files, for the settings of a state (docs/scene-schema.md):
///   estimate  safety times the diagonal estimate of the acting contacts, every 100 steps (PFC3D eq. 1.31)
///   bound     safety times the damped block bound (local damping, dashpots) of all listed pairs as if they
///             acted: proven until the next list, whatever opens or closes. Of a surface's triangles those
///             count that are touched now, so there it is asked every 100 steps and holds for these
///   fixed     the scene's dt
/// Where the scene scales masses, the step is the one that it asks for, and masses are renewed instead
/// (`selective` with policy `tracked`: where a proof within rooms asks for it)
/// (cycle/mass_scaling.hpp), as often as `bound` would be asked. Bounds count the largest α for all bodies.
/// Where stiffnesses follow the overlap both are asked every few steps, and hold for the overlaps of the
/// moment, and for the impacts of balls that are near. Balls that touch nothing count in the first two with
/// the contact that they may form next, so that a scene without contacts has a step too.
TimestepPolicy policy_of(const model::Scene& settings);

}  // namespace eigengrain::cycle
