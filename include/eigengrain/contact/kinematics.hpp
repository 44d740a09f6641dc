#pragma once

#include "eigengrain/base/type_list.hpp"
#include "eigengrain/contact/facet.hpp"
#include "eigengrain/contact/geometry.hpp"
#include "eigengrain/contact/law.hpp"
#include "eigengrain/contact/shear_transport.hpp"
#include "eigengrain/model/bodies.hpp"
#include "eigengrain/model/surface.hpp"
#include "eigengrain/model/surroundings.hpp"
#include "eigengrain/model/wall_motion.hpp"

#include <algorithm>
#include <cstdint>
#include <span>
#include <string_view>
#include <tuple>

/// How the motion of two sides becomes the motion of their contact: the B of K = BᵀDB.
namespace eigengrain::contact {

/// A contact is a triple: side a, side b (its meaning is the kinematics' own) and the periodic image of b.
struct Pair {
  std::int32_t a = 0;
  std::int32_t b = 0;
  model::Image image{};
  /// With a facet: 1 or -1, on which side of it the ball is; twice that where the pair is no contact, as
  /// another facet of the surface gives it (facet_choice.hpp).
  std::int8_t side = 0;

  bool is_contact() const { return side == 1 || side == -1; }
};

/// The order of pairs in lists and groups: by a, then b, then image.
inline bool precedes(const Pair& left, const Pair& right) {
  return std::tie(left.a, left.b, left.image) < std::tie(right.a, right.b, right.image);
}

/// Where a surface is.
struct SurfacePlace {
  Vec3 start = Vec3::Zero();  ///< its centre where its facets are described, m
  model::WallPose pose;       ///< its centre now
  bool moved = false;         ///< else it is where its facets are described

  Vec3 to_local(const Vec3& x) const {
    return moved ? Vec3(start + pose.orientation.conjugate() * (x - pose.centre)) : x;
  }
  Vec3 turned(const Vec3& v) const { return moved ? Vec3(pose.orientation * v) : v; }
};

/// Where the sides of contacts are. `position` may be a trial position, apart from bodies.position.
struct Placement {
  std::span<const Vec3> position;  ///< [bodies] centres, m
  std::span<const double> radius;  ///< [bodies] m
  std::span<const model::Plane> walls;
  const model::PeriodicCell& cell;
  std::span<const double> mass{};  ///< [bodies] kg; for laws that ask for the rate
  /// Walls as they were in the middle of the step; empty where none moves.
  std::span<const model::Plane> middle_walls{};
  const model::Facets* facets = nullptr;  ///< of all surfaces
  std::span<const SurfacePlace> surfaces{};
  std::span<const SurfacePlace> middle_surfaces{};  ///< in the middle of the step; empty where none moves
  double lever_cut = to_contact_point;              ///< of the overlap, from the levers
  std::span<const Quat> orientation{};  ///< [bodies] or empty; a trial orientation where position is one
  /// Facets with those of deformable surfaces in the middle of the step; null: where they are.
  const model::Facets* middle_facets = nullptr;
};

/// Side a is a ball, side b another ball (or an image of the same one).
struct BallBall {
  static constexpr std::string_view name = "ball-ball";
  static constexpr bool second_is_body = true;

  /// C, by which n turns with the motion of the centres: dn = C (u_b - u_a). Here (1 - nnᵀ)/d.
  static Mat3 curvature(const Placement& /*placement*/, const Pair& /*pair*/,
                        const ContactGeometry& geometry) {
    const Vec3& n = geometry.normal;
    return (Mat3::Identity() - n * n.transpose()) / geometry.branch().dot(n);
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
                     placement.position[b] + placement.cell.shift(pair.image) - back_b, placement.radius[b],
                     placement.lever_cut);
  }
};

/// Side a is a ball, side b a plane, which has no unknowns; its motion is given.
struct BallPlane {
  static constexpr std::string_view name = "ball-wall";
  static constexpr bool second_is_body = false;

  static Mat3 curvature(const Placement& /*placement*/, const Pair& /*pair*/,
                        const ContactGeometry& /*geometry*/) {
    return Mat3::Zero();
  }

  static ContactGeometry geometry(const Placement& placement, const Pair& pair) {
    const auto a = static_cast<std::size_t>(pair.a);
    return ball_plane(placement.position[a], placement.radius[a], placement.walls[pair.b],
                      placement.lever_cut);
  }
  /// The geometry in the middle of the step: a wall that turns is not just set back.
  static ContactGeometry geometry_before(const Placement& placement, const Pair& pair, const Vec3& back_a,
                                         const Vec3& /*back_b*/) {
    const auto a = static_cast<std::size_t>(pair.a);
    const auto walls = placement.middle_walls.empty() ? placement.walls : placement.middle_walls;
    return ball_plane(placement.position[a] - back_a, placement.radius[a], walls[pair.b],
                      placement.lever_cut);
  }
  /// Index of the wall that side b belongs to.
  static std::int32_t wall(const Placement& /*placement*/, const Pair& pair) { return pair.b; }
};

/// Side a is a ball, side b a triangle of a surface; pairs that are no contacts have no overlap.
struct BallFacet {
  static constexpr std::string_view name = "ball-facet";
  static constexpr bool second_is_body = false;

  /// The ball's centre in the frame in which the facets are described.
  static Vec3 local_centre(const Placement& placement, std::span<const SurfacePlace> places, const Pair& pair,
                           const Vec3& back = Vec3::Zero()) {
    return place_of(placement, places, pair)
        .to_local(placement.position[pair.a] - placement.cell.shift(pair.image) - back);
  }

  static Mat3 curvature(const Placement& placement, const Pair& pair, const ContactGeometry& /*geometry*/) {
    const Vec3 x = local_centre(placement, placement.surfaces, pair);
    const Mat3 local = feature_curvature(x, facet_of(placement, pair), feature(placement, pair));
    const SurfacePlace& place = place_of(placement, placement.surfaces, pair);
    if (!place.moved) return local;
    const Mat3 turn = place.pose.orientation.toRotationMatrix();
    return turn * local * turn.transpose();
  }

  static ContactGeometry geometry(const Placement& placement, const Pair& pair) {
    return geometry_of(placement, placement.surfaces, facet_of(placement, pair), pair, Vec3::Zero());
  }
  /// In the middle of the step, with the feature that is touched at its end: what changes there is none of
  /// the motion's.
  static ContactGeometry geometry_before(const Placement& placement, const Pair& pair, const Vec3& back_a,
                                         const Vec3& /*back_b*/) {
    const model::Facets& facets =
        placement.middle_facets != nullptr ? *placement.middle_facets : *placement.facets;
    return geometry_of(placement,
                       placement.middle_surfaces.empty() ? placement.surfaces : placement.middle_surfaces,
                       facets.facet[static_cast<std::size_t>(pair.b)], pair, back_a);
  }
  /// Whether side b is a part of a deformable body, whose nodes feel the contact (skin.hpp).
  static bool deforms(const Placement& placement, const Pair& pair) {
    return placement.facets->deforms(pair.b);
  }
  static std::int32_t wall(const Placement& placement, const Pair& pair) {
    return static_cast<std::int32_t>(placement.walls.size()) + facet_of(placement, pair).surface;
  }

 private:
  static const model::Facet& facet_of(const Placement& placement, const Pair& pair) {
    return placement.facets->facet[static_cast<std::size_t>(pair.b)];
  }
  static const SurfacePlace& place_of(const Placement& placement, std::span<const SurfacePlace> places,
                                      const Pair& pair) {
    return places[static_cast<std::size_t>(facet_of(placement, pair).surface)];
  }
  static FacetFeature feature(const Placement& placement, const Pair& pair) {
    return nearest_point(local_centre(placement, placement.surfaces, pair), facet_of(placement, pair))
        .feature;
  }
  static ContactGeometry geometry_of(const Placement& placement, std::span<const SurfacePlace> places,
                                     const model::Facet& facet, const Pair& pair, const Vec3& back) {
    const SurfacePlace& place = place_of(placement, places, pair);
    const bool deformable = deforms(placement, pair);
    ContactGeometry result =
        ball_feature(local_centre(placement, places, pair, back), placement.radius[pair.a], facet,
                     feature(placement, pair), pair.side < 0 ? -1 : 1, place.start,
                     deformable ? to_nearest_point : placement.lever_cut);
    if (!pair.is_contact()) result.overlap = std::min(result.overlap, 0.0);
    if (deformable) {
      result.lever_b.setZero();  // what moves is the point itself
      return result;
    }
    result.normal = place.turned(result.normal);
    result.lever_a = place.turned(result.lever_a);
    result.lever_b = place.turned(result.lever_b);
    return result;
  }
};

using KinematicsTypes = TypeList<BallBall, BallPlane, BallFacet>;

/// Displacement and rotation of one side since the committed state.
template <class Real>
struct SideMotionIn {
  Vec3Of<Real> translation = Vec3Of<Real>::Zero();  ///< u, m
  Vec3Of<Real> rotation = Vec3Of<Real>::Zero();     ///< θ, rad
};
using SideMotion = SideMotionIn<double>;

/// δ = (u_b + θ_b × R_b) - (u_a + θ_a × R_a), φ = θ_b - θ_a, with the levers of the present geometry.
template <class Real>
MotionIn<Real> contact_motion(const GeometryOf<Real>& geometry, const Same<SideMotionIn<Real>>& a,
                              const Same<SideMotionIn<Real>>& b) {
  return {.normal = geometry.normal,
          .overlap = geometry.overlap,
          .displacement = (b.translation + b.rotation.cross(geometry.lever_b)) -
                          (a.translation + a.rotation.cross(geometry.lever_a)),
          .rotation = b.rotation - a.rotation,
          .spin = 0.5 * (a.rotation + b.rotation).dot(geometry.normal),
          .reduced_radius = geometry.reduced_radius};
}

/// The same with n and the levers of the middle of the step, in which a rigid motion makes no spurious
/// increment: of size θ³ for a rotation by θ instead of θ² (docs/theory.md). What was found there is carried
/// on to the end of the step, with the contact plane and by the second half of the spin about n: left where
/// it was, it would err by Δt² a step, and the cycle would be of first order. Laws may take all parts along
/// the present n.
template <class Real>
MotionIn<Real> mid_step_motion(const GeometryOf<Real>& geometry, const GeometryOf<Real>& middle,
                               const Same<SideMotionIn<Real>>& a, const Same<SideMotionIn<Real>>& b) {
  const Vec3Of<Real>& n = geometry.normal;
  MotionIn<Real> motion = contact_motion<Real>(middle, a, b);
  motion.normal = n;
  motion.overlap = geometry.overlap;
  motion.reduced_radius = geometry.reduced_radius;
  motion.displacement = rotate_onto<Real>(motion.displacement, middle.normal, n);
  motion.rotation = rotate_onto<Real>(motion.rotation, middle.normal, n);
  motion.displacement += (0.5 * motion.spin * n.cross(motion.displacement)).eval();
  motion.rotation += (0.5 * motion.spin * n.cross(motion.rotation)).eval();
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
    return law.mid_step() ? mid_step_motion(geometry,
                                            Kinematics::geometry_before(placement, pair, 0.5 * a.translation,
                                                                        0.5 * b.translation),
                                            a, b)
                          : contact_motion(geometry, a, b);
}

/// m_1 m_2/(m_1 + m_2) of the sides, at a wall the ball's mass, kg.
template <class Kinematics>
double reduced_mass(const Placement& placement, const Pair& pair) {
  const double a = placement.mass[static_cast<std::size_t>(pair.a)];
  if constexpr (Kinematics::second_is_body) {
    const double b = placement.mass[static_cast<std::size_t>(pair.b)];
    return a * b / (a + b);
  }
  return a;
}

/// What a contact does to its ends: force (N) and moment about the centre (N m) on each.
template <class Real>
struct EndForcesIn {
  Vec3Of<Real> force_a;
  Vec3Of<Real> moment_a;
  Vec3Of<Real> force_b;
  Vec3Of<Real> moment_b;
};
using EndForces = EndForcesIn<double>;

/// The transpose of contact_motion (Bᵀ, PFC3D eq. 1.20): -F at the first end, +F at the second.
template <class Real>
EndForcesIn<Real> end_forces(const GeometryOf<Real>& geometry, const Same<ForceIn<Real>>& f) {
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

/// The force of the springs of a contact as it stands.
template <class Law>
ContactForce spring_force(const Law& law, const Placement& placement, const Pair& pair,
                          const ContactGeometry& geometry, const typename Law::State& state) {
  typename Law::State discarded;
  return law.evaluate(at_rest_for<Law>(placement, pair, geometry), state, discarded);
}

/// The same with that of its dashpots in the step that led to its state.
template <class Law>
ContactForce force_now(const Law& law, const Placement& placement, const Pair& pair,
                       const ContactGeometry& geometry, const typename Law::State& state) {
  ContactForce force = spring_force(law, placement, pair, geometry, state);
  if constexpr (asks_rate<Law>) force.force += state.viscous;
  return force;
}

}  // namespace eigengrain::contact
