#pragma once

#include "eigengrain/cycle/cycle.hpp"

namespace eigengrain::cycle {

/// The policies of scene files, for the settings of a state (docs/scene-schema.md):
///   estimate  safety times the diagonal estimate of the acting contacts, every 100 steps (PFC3D eq. 1.31)
///   bound     safety times the scaled block bound with the local damping in use, of all listed pairs as if
///   they
///             acted: proven until the next list, whatever opens or closes
///   fixed     the scene's dt
/// The first two never exceed what a single contact of the lightest ball allows, so that a scene without
/// contacts has a step too.
TimestepPolicy policy_of(const model::Scene& settings);

/// The stable step of any single head-on contact that the rules of the scene allow, by the rule √(m/k): what
/// balls that have not met yet are held to, s; infinite where no law acts.
double single_contact_estimate(const model::Scene& settings, const model::Bodies& bodies);

}  // namespace eigengrain::cycle
