#pragma once

#include "eigengrain/contact/laws/linear.hpp"

#include <array>
#include <span>

namespace eigengrain::contact {

/// The linear law where it transmits no shear (friction or k_s zero, and no `tension`): F = k_n U n while U >
/// 0 (PFC3D eq. 1.10). No history, so its contacts store none, and no rotations.
class LinearFrictionless {
 public:
  template <class Real>
  struct StateIn {};
  using State = StateIn<double>;
  static constexpr std::array<StateField, 0> state_fields{};

  static constexpr auto name = Linear::name;
  static constexpr auto description = Linear::description;
  static constexpr auto& parameters = Linear::parameters;

  static bool serves(std::span<const double> values) {
    const Linear general = Linear::from_values(values);
    return Linear::serves(values) && !general.needs_rotation() && !general.tension();
  }
  static LinearFrictionless from_values(std::span<const double> values) {
    return LinearFrictionless(values[0]);
  }

  explicit LinearFrictionless(double kn) : kn_(kn) {}

  bool needs_rotation() const { return false; }
  static constexpr bool mid_step() { return false; }
  State formed(const Vec3& /*normal*/) const { return {}; }

  template <class Real>
  MaskOf<Real> acts(const MotionIn<Real>& motion, const StateIn<Real>& /*old*/) const {
    return motion.overlap > 0.0;
  }

  template <class Real>
  ForceIn<Real> evaluate(const MotionIn<Real>& motion, const StateIn<Real>& old,
                         StateIn<Real>& /*next*/) const {
    if (none(acts(motion, old))) return {};
    return {.force = kn_ * motion.overlap * motion.normal};
  }

  ContactStiffness stiffness(const ContactMotion& /*motion*/, const State& /*old*/) const {
    return {.normal = kn_};
  }

  ContactTangent tangent(const ContactMotion& motion, const State& old) const {
    return {.translation = stiffness(motion, old).translation(motion.normal)};
  }

  double energy(const ContactMotion& motion, const State& old) const {
    return acts(motion, old) ? 0.5 * kn_ * motion.overlap * motion.overlap : 0.0;
  }

 private:
  double kn_;  // N/m
};

}  // namespace eigengrain::contact
