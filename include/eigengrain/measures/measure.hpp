#pragma once

#include "eigengrain/assembly/model.hpp"
#include "eigengrain/measures/acting_contacts.hpp"
#include "eigengrain/measures/window.hpp"
#include "eigengrain/model/region.hpp"

#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

/// Averages over regions of an assembly (docs/theory.md, "Measures"). Sums run in one order: the same to the
/// bit on any number of threads.
namespace eigengrain::measures {

/// A mean of nothing.
inline constexpr double nothing = std::numeric_limits<double>::quiet_NaN();

/// Mean stress in a window, Pa, tension positive: σ = -(1/V) Σ w F ⊗ ℓ, w the part of the branch ℓ that is
/// inside. σ(i, j) is the force along i on a plane across j; symmetric where moments balance.
Mat3 mean_stress(const Window& window, const assembly::Model& model, std::span<const ActingContact> contacts);

/// Mean stress of each body over its own volume [bodies], Pa: (1/V_i) Σ f ⊗ R, f the force of a contact on
/// the body and R its lever. Σ V_i σ_i = -Σ F ⊗ ℓ. Balls of a clump have the stress of the clump.
std::vector<Mat3> body_stresses(const assembly::Model& model);

/// Velocity gradient L of the best fit v = v̄ + L (x - x̄) to the bodies with their centres in the window, by
/// least squares, 1/s. Velocities are those of the model (in a run those of half a step ago). None where the
/// centres lie in a plane.
std::optional<Mat3> velocity_gradient(const Window& window, const model::Bodies& bodies);

/// 1 - (volume of balls in the window)/V, with exact partial volumes; where balls overlap each counts in
/// full, but those of one clump, whose common volume counts once (in the parts of it that a window cuts, in
/// the mean over its balls).
double porosity(const Window& window, const model::Bodies& bodies);

/// Means over bodies (balls, and clumps as a whole) with their centres in a window and over the contacts at
/// them, at walls too. A contact of two bodies counts at both.
struct Fabric {
  std::int64_t bodies = 0;
  std::int64_t rattlers = 0;
  double coordination = nothing;      ///< contacts a body
  double without_rattlers = nothing;  ///< the same of bodies that are no rattlers, and contacts among them
  Mat3 tensor = Mat3::Constant(nothing);  ///< mean of n ⊗ n; its trace is 1
  double sliding = nothing;               ///< part of the contacts that slide
};

Fabric fabric(const Window& window, const assembly::Model& model, std::span<const ActingContact> contacts,
              const std::vector<bool>& rattlers);

/// All of these.
struct Measure {
  double volume = 0;  ///< m³
  Mat3 stress = Mat3::Zero();
  std::optional<Mat3> velocity_gradient;
  double porosity = 0;
  Fabric fabric;

  /// Symmetric part of the velocity gradient.
  std::optional<Mat3> strain_rate() const;
};

/// [regions] Contacts are evaluated once for all of them: about the cost of one serial sum of forces, and a
/// pass over bodies and contacts a region.
std::vector<Measure> measure(const assembly::Model& model, std::span<const model::Region> regions);

}  // namespace eigengrain::measures
