#pragma once

#include "eigengrain/base/type_list.hpp"
#include "eigengrain/contact/geometry.hpp"
#include "eigengrain/contact/law.hpp"
#include "eigengrain/contact/shear_transport.hpp"
#include "eigengrain/model/bodies.hpp"
#include "eigengrain/model/surroundings.hpp"

#include <cstdint>
#include <span>
#include <string_view>

/// How the motion of two sides becomes the motion of their contact: the B of K = BᵀDB.
namespace eigengrain::contact {

/// A contact is a triple: side a, side b (its meaning is the kinematics' own) and the periodic image of b.
struct Pair {
  std::int32_t a = 0;
  std::int32_t b = 0;
  model::Image image{};
};

/// Where the sides of contacts are. `position` may be a trial position, apart from bodies.position.
struct Placement {
  std::span<const Vec3> position;  ///< [bodies] centres, m
  std::span<const double> radius;  ///< [bodies] m
  std::span<const model::Plane> walls;
  const model::PeriodicCell& cell;
  std::span<const Quat> orientation{};  ///< [bodies] or empty; a trial orientation where position is one
};

/// Side a is a ball, side b another ball (or an image of the same one).
struct BallBall {
  static constexpr std::string_view name = "ball-ball";
  static constexpr bool second_is_body = true;

  /// 1/d, by which n turns with the transverse motion of the centres: dn = (1 - nnᵀ)(u_b - u_a)/d.
  static double curvature(const ContactGeometry& geometry) {
    return 1.0 / (geometry.lever_a - geometry.lever_b).dot(geometry.normal);
  }

  static ContactGeometry geometry(const Placement& placement, const Pair& pair) {
    return geometry_before(placement, pair, Vec3::Zero(), Vec3::Zero());
  }
  /// The geometry with the sides set back by these displacements, m.
  static ContactGeometry geometry_before(const Placement& placement, const Pair& pair, const Vec3& back_a,
                                         const Vec3& back_b) {
    const auto a = static_cast<std::size_t>(pair.a);
    const auto b = static_cast<std::size_t>(pair.b);
    return ball_ball(placement.position[a] - back_a, placement.radius[a],
                     placement.position[b] + placement.cell.shift(pair.image) - back_b, placement.radius[b]);
  }
};

/// Side a is a ball, side b a plane, which has no unknowns.
struct BallPlane {
  static constexpr std::string_view name = "ball-wall";
  static constexpr bool second_is_body = false;

  static double curvature(const ContactGeometry& /*geometry*/) { return 0.0; }

  static ContactGeometry geometry(const Placement& placement, const Pair& pair) {
    return geometry_before(placement, pair, Vec3::Zero(), Vec3::Zero());
  }
  static ContactGeometry geometry_before(const Placement& placement, const Pair& pair, const Vec3& back_a,
                                         const Vec3& /*back_b*/) {
    const auto a = static_cast<std::size_t>(pair.a);
    return ball_plane(placement.position[a] - back_a, placement.radius[a], placement.walls[pair.b]);
  }
};

using KinematicsTypes = TypeList<BallBall, BallPlane>;

/// Displacement and rotation of one side since the committed state.
struct SideMotion {
  Vec3 translation = Vec3::Zero();  ///< u, m
  Vec3 rotation = Vec3::Zero();     ///< θ, rad
};

/// δ = (u_b + θ_b × R_b) - (u_a + θ_a × R_a), φ = θ_b - θ_a, with the levers of the present geometry.
inline ContactMotion contact_motion(const ContactGeometry& geometry, const SideMotion& a,
                                    const SideMotion& b) {
  return {.normal = geometry.normal,
          .overlap = geometry.overlap,
          .displacement = (b.translation + b.rotation.cross(geometry.lever_b)) -
                          (a.translation + a.rotation.cross(geometry.lever_a)),
          .rotation = b.rotation - a.rotation,
          .spin = 0.5 * (a.rotation + b.rotation).dot(geometry.normal)};
}

/// The same with n and the levers of the middle of the step, in which a rigid motion makes no spurious
/// increment: of size θ³ for a rotation by θ instead of θ² (docs/theory.md). What was found there is carried
/// on to the end of the step, with the contact plane and, for δ, by the second half of the spin about n: left
/// where it was, it would err by Δt² a step, and the cycle would be of first order. Laws may take all parts
/// along the present n.
template <class Kinematics>
ContactMotion mid_step_motion(const Placement& placement, const Pair& pair, const ContactGeometry& geometry,
                              const SideMotion& a, const SideMotion& b) {
  const ContactGeometry middle =
      Kinematics::geometry_before(placement, pair, 0.5 * a.translation, 0.5 * b.translation);
  const Vec3& n = geometry.normal;
  ContactMotion motion = contact_motion(middle, a, b);
  motion.normal = n;
  motion.overlap = geometry.overlap;
  motion.displacement = rotate_onto(motion.displacement, middle.normal, n);
  motion.rotation = rotate_onto(motion.rotation, middle.normal, n);
  motion.displacement += 0.5 * motion.spin * n.cross(motion.displacement);
  return motion;
}

/// The pose of a contact between two bodies that have orientations.
inline ContactPose pose_of(const Placement& placement, const Pair& pair, const ContactGeometry& geometry) {
  return {.lever_a = geometry.lever_a,
          .lever_b = geometry.lever_b,
          .orientation_a = placement.orientation[static_cast<std::size_t>(pair.a)],
          .orientation_b = placement.orientation[static_cast<std::size_t>(pair.b)]};
}

/// The motion of a contact as its law wants it.
template <class Kinematics, class Law>
MotionOf<Law> motion_for(const Law& law, const Placement& placement, const Pair& pair,
                         const ContactGeometry& geometry, const SideMotion& a, const SideMotion& b) {
  if constexpr (in_total_form<Law>)
    return pose_of(placement, pair, geometry);
  else
    return law.mid_step() ? mid_step_motion<Kinematics>(placement, pair, geometry, a, b)
                          : contact_motion(geometry, a, b);
}

/// What a contact does to its ends: force (N) and moment about the centre (N m) on each.
struct EndForces {
  Vec3 force_a;
  Vec3 moment_a;
  Vec3 force_b;
  Vec3 moment_b;
};

/// The transpose of contact_motion (Bᵀ, PFC3D eq. 1.20): -F at the first end, +F at the second.
inline EndForces end_forces(const ContactGeometry& geometry, const ContactForce& f) {
  return {.force_a = -f.force,
          .moment_a = -geometry.lever_a.cross(f.force) - f.moment,
          .force_b = f.force,
          .moment_b = geometry.lever_b.cross(f.force) + f.moment};
}

/// The motion of a contact that stands still.
inline ContactMotion at_rest(const ContactGeometry& geometry) {
  return contact_motion(geometry, {}, {});
}

/// The same as the law wants it.
template <class Law>
MotionOf<Law> at_rest_for(const Placement& placement, const Pair& pair, const ContactGeometry& geometry) {
  if constexpr (in_total_form<Law>)
    return pose_of(placement, pair, geometry);
  else
    return at_rest(geometry);
}

}  // namespace eigengrain::contact
