#pragma once

#include "eigengrain/base/vec.hpp"
#include "eigengrain/model/material.hpp"

#include <algorithm>
#include <array>
#include <concepts>
#include <limits>
#include <optional>
#include <span>
#include <string_view>
#include <type_traits>

/// The contract between a contact and its law (docs/add-a-law.md).
///
/// A law is a value that holds its parameters and offers pure functions: nothing is stored while a force is
/// computed, so that Newton iterations, line searches and finite differences may evaluate as often as they
/// like, and whoever runs the explicit cycle commits the new state.
///
/// Signs (docs/notation.md): n is the unit normal from the contact's first side to its second; the force F is
/// that of the first side on the second, so a compressive force has F·n > 0.
namespace eigengrain::contact {

/// What a law may know about its contact; with Real a Pack, about several at once.
template <class Real>
struct MotionIn {
  using Vector = Vec3Of<Real>;

  Vector normal = Vector::Zero();  ///< n now, unit
  Real overlap = 0;                ///< U now, m; positive when the surfaces interpenetrate
  Vector displacement =
      Vector::Zero();  ///< increment of the relative displacement δ since the committed state, m
  Vector rotation = Vector::Zero();  ///< increment of the relative rotation φ, rad
  Real spin = 0;                     ///< increment of the mean rotation ½(θ_1 + θ_2) about n, rad
  Real reduced_radius = 0;           ///< R* of the sides, 1/R* = Σ 1/R, m; a wall is flat
  /// For laws that ask for the rate (asks_rate) alone.
  Vector velocity = Vector::Zero();  ///< of δ, m/s; zero where nothing moves in time, as in Newton's method
  Real reduced_mass = 0;             ///< m_1 m_2/(m_1 + m_2), at a wall the ball's, kg
};
using ContactMotion = MotionIn<double>;

/// Whether a law is written for several contacts at once: its acts() and evaluate() take MotionIn<Real> and
/// StateIn<Real> for any Real, State being StateIn<double>. What evaluate() gives for lanes that do not act
/// is left out by the caller. Other laws are asked for one contact after the other.
template <class L>
inline constexpr bool takes_packs = requires {
  requires std::is_same_v<typename L::State, typename L::template StateIn<double>>;
};

/// What a law in total form knows instead: where its sides are and how they are turned, not how they came
/// there. A law asks for it by `using Motion = ContactPose`, and the scene then has orientations.
struct ContactPose {
  Vec3 lever_a = Vec3::Zero();  ///< R_a now, m
  Vec3 lever_b = Vec3::Zero();  ///< R_b now, m; x_b - x_a = R_a - R_b
  Quat orientation_a = Quat::Identity();
  Quat orientation_b = Quat::Identity();
};

/// What acts at the contact point, of the first side on the second.
template <class Real>
struct ForceIn {
  Vec3Of<Real> force = Vec3Of<Real>::Zero();   ///< N
  Vec3Of<Real> moment = Vec3Of<Real>::Zero();  ///< N m, beyond that of `force` about the centres
};
using ContactForce = ForceIn<double>;

/// Elastic stiffness of a contact in its own frame (eq. 1.34): along n and across it. Isotropic across n.
template <class Real>
struct StiffnessIn {
  Real normal = 0;   ///< k_n, N/m
  Real shear = 0;    ///< k_s, N/m
  Real twist = 0;    ///< κ_n, N m
  Real bending = 0;  ///< κ_s, N m

  /// D of the relative displacement: k_n nnᵀ + k_s (1 - nnᵀ).
  Mat3 translation(const Vec3& n) const { return normal_and_shear(n, normal, shear); }
  /// D of the relative rotation: κ_n nnᵀ + κ_s (1 - nnᵀ).
  Mat3 rotation(const Vec3& n) const { return normal_and_shear(n, twist, bending); }

  friend StiffnessIn operator*(double factor, const StiffnessIn& k) {
    return {factor * k.normal, factor * k.shear, factor * k.twist, factor * k.bending};
  }

 private:
  static Mat3 normal_and_shear(const Vec3& n, double along, double across) {
    return across * Mat3::Identity() + (along - across) * n * n.transpose();
  }
};

using ContactStiffness = StiffnessIn<double>;

/// Damping ratios β of the dashpots of a contact: c = 2β√(m k), m the reduced mass and k the stiffness along
/// n and across it (PFC3D eqs. 1.57-1.60).
struct DampingRatios {
  double normal = 0;
  double shear = 0;
};

/// Consistent derivative of the force law on its present branch, at rest and at fixed n: -dF/dδ, -dM/dφ and
/// -dM/dδ.
struct ContactTangent {
  Mat3 translation = Mat3::Zero();  ///< N/m; unsymmetric while the contact slips
  Mat3 rotation = Mat3::Zero();     ///< N m
  Mat3 coupling = Mat3::Zero();     ///< N; of a moment whose limit follows the normal force
};

/// One parameter of a law, as scene files and their documentation see it.
struct ParameterDescription {
  enum class Kind { quantity, flag };

  std::string_view name;
  Kind kind = Kind::quantity;
  std::string_view unit;                  ///< SI, as in "N/m"; empty for a pure number
  std::optional<double> default_value{};  ///< none: the scene must give it. Flags are 0 or 1
  double minimum = -std::numeric_limits<double>::infinity();
  bool minimum_allowed = true;  ///< whether the minimum itself is a valid value
  double maximum = std::numeric_limits<double>::infinity();
  std::string_view description;
  /// Where a rule may leave the parameter out: the stiffness of one side, from its material; the pair has
  /// both in series, 1/(1/a + 1/b). Nothing where the material does not say.
  std::optional<double> (*of_material)(const model::Material&) = nullptr;
  std::string_view material_keys{};  ///< what it is computed from, for messages: "young and poisson"
};

/// The entries of two lists, one after the other.
template <class T, std::size_t n, std::size_t m>
constexpr std::array<T, n + m> joined(const std::array<T, n>& first, const std::array<T, m>& second) {
  std::array<T, n + m> all{};
  std::copy(first.begin(), first.end(), all.begin());
  std::copy(second.begin(), second.end(), all.begin() + n);
  return all;
}

/// Whether all values from the place `first` on are the defaults of their parameters.
constexpr bool are_defaults(std::span<const double> values, std::span<const ParameterDescription> parameters,
                            std::size_t first) {
  for (std::size_t k = first; k < values.size(); ++k)
    if (values[k] != parameters[k].default_value) return false;
  return true;
}

/// One part of a law's state, as files see it. A state is plain doubles, part after part.
struct StateField {
  std::string_view name;
  std::string_view unit;  ///< SI; empty for a pure number
  int components = 1;     ///< 1, 3, or 4 for a quaternion (x, y, z, w)
};

/// Numbers in a state with these parts.
constexpr std::size_t state_numbers(std::span<const StateField> fields) {
  std::size_t count = 0;
  for (const StateField& field : fields) count += static_cast<std::size_t>(field.components);
  return count;
}

/// Whether a law wants velocity and reduced mass in its ContactMotion: it then says `static constexpr bool
/// asks_rate = true`, offers damping(), and keeps the force of its dashpots as `viscous` in its state.
template <class L>
inline constexpr bool asks_rate = requires {
  requires L::asks_rate;
};

namespace detail {
template <class L>
struct MotionSelector {
  using type = ContactMotion;
};
template <class L>
requires requires {
  typename L::Motion;
}
struct MotionSelector<L> {
  using type = typename L::Motion;
};
}  // namespace detail

/// What a law is evaluated for: increments, or the pose of its sides.
template <class L>
using MotionOf = typename detail::MotionSelector<L>::type;

template <class L>
inline constexpr bool in_total_form = std::is_same_v<MotionOf<L>, ContactPose>;

/// What `tangent` gives: D at fixed n, from which contact/consistent_tangent.hpp makes the whole; in total
/// form the whole itself, -∂(F_a, M_a, F_b, M_b)/∂(u_a, θ_a, u_b, θ_b).
template <class L>
using TangentOf = std::conditional_t<in_total_form<L>, Mat12, ContactTangent>;

/// A law: a state that belongs to each contact (may be empty) and pure functions of motion and old state.
template <class L>
concept ContactLaw = requires(const L& law, const ContactMotion& motion, const MotionOf<L>& full,
                              const typename L::State& state, typename L::State& next,
                              std::span<const double> values) {
  { L::name } -> std::convertible_to<std::string_view>;
  { L::description } -> std::convertible_to<std::string_view>;
  { L::parameters } -> std::convertible_to<std::span<const ParameterDescription>>;
  /// Builds the law from values in the order of its parameters.
  { L::from_values(values) } -> std::same_as<L>;
  /// The parts of State, in its order.
  { L::state_fields } -> std::convertible_to<std::span<const StateField>>;
  requires std::is_empty_v<typename L::State> ||
      sizeof(typename L::State) == sizeof(double) * state_numbers(L::state_fields);
  /// Whether this class is the one for these values, where several share a name.
  { L::serves(values) } -> std::same_as<bool>;
  /// The state of a contact that forms with this normal.
  { law.formed(motion.normal) } -> std::same_as<typename L::State>;
  /// Whether the contact transmits anything. Where it does not, force and energy are zero, and stiffness and
  /// tangent mean nothing. A contact whose surfaces are apart and whose state is State{} does not act.
  { law.acts(motion, state) } -> std::same_as<bool>;
  /// Force after the motion; `next` receives the state that a commit would store.
  { law.evaluate(full, state, next) } -> std::same_as<ContactForce>;
  { law.stiffness(motion, state) } -> std::same_as<ContactStiffness>;
  { law.tangent(full, state) } -> std::same_as<TangentOf<L>>;
  /// Elastic energy stored after the motion, J.
  { law.energy(full, state) } -> std::same_as<double>;
  /// Whether the increments are wanted with the geometry of the middle of the step (contact/kinematics.hpp).
  { law.mid_step() } -> std::same_as<bool>;
  /// Whether any contact of the law can ever have shear or rotational stiffness.
  { law.needs_rotation() } -> std::same_as<bool>;
};

}  // namespace eigengrain::contact
