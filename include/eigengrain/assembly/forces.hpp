#pragma once

#include "eigengrain/assembly/model.hpp"
#include "eigengrain/contact/dissipation.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace eigengrain::assembly {

/// Displacement of every body since the committed state. Rotations may be empty: none.
struct Displacement {
  std::vector<Vec3> translation;  ///< [bodies] u, m
  std::vector<Vec3> rotation;     ///< [bodies] θ, rad; or empty
};

/// Where bodies are and how they came there from the committed state: by u = duration · velocity and
/// θ = duration · spin. The cycle passes its velocities and its step; displacements are velocities for a
/// duration of one.
struct Trial {
  std::span<const Vec3> position;  ///< [bodies] committed position + u, m
  std::span<const Vec3> velocity;  ///< [bodies]
  std::span<const Vec3> spin;      ///< [bodies]; or empty: nothing turns
  double duration = 1;

  contact::SideMotion side(std::int32_t body) const {
    const auto i = static_cast<std::size_t>(body);
    return {duration * velocity[i], spin.empty() ? Vec3(Vec3::Zero()) : Vec3(duration * spin[i])};
  }
};

/// The motion of a contact in a trial state, as its law wants it.
template <class Kinematics, class Law>
contact::ContactMotion motion_in(const Law& law, const contact::Placement& placement, const Trial& trial,
                                 const contact::Pair& pair, const contact::ContactGeometry& geometry) {
  contact::SideMotion second;
  if constexpr (Kinematics::second_is_body) second = trial.side(pair.b);
  return contact::motion_for<Kinematics>(law, placement, pair, geometry, trial.side(pair.a), second);
}

/// What the contacts exert on every body: force (N) and moment about its centre (N m).
struct BodyForces {
  std::vector<Vec3> force;
  std::vector<Vec3> moment;  ///< empty where nothing turns
};

/// The sum of contact forces on every body, for one contact graph: the work of the explicit cycle and of a
/// residual. Threads share fixed chunks of bodies; a contact is evaluated once, in the chunk of its first
/// body, and what it does to a body of another chunk is kept and added in the end. So every sum has one order
/// (the order of the contacts), and the result is the same to the bit on any number of threads. Nothing is
/// allocated after construction. Cost O(contacts).
class ContactForceSum {
 public:
  /// turns  whether moments are wanted
  ContactForceSum(const Model& model, bool turns);

  /// Forces after a trial displacement. Nothing is stored in the contacts: the same call with the same
  /// displacement gives the same forces.
  void evaluate(const Model& model, const Trial& trial, BodyForces& sum);
  /// The same, and the contacts remember: the trial displacement becomes the committed state. What they
  /// dissipate on the way is added to `dissipated` if it is given; if not, it is not computed.
  void advance(Model& model, const Trial& trial, BodyForces& sum, contact::Dissipation* dissipated = nullptr);

 private:
  /// A group's contacts by chunk of their first body, and where each puts its force on a body elsewhere.
  struct GroupPlan {
    std::vector<std::int64_t> starts;  ///< [chunks + 1]
    std::vector<std::int32_t> slot;    ///< [contacts] into foreign_force_, or own_chunk; empty for walls
  };
  static constexpr std::int32_t own_chunk = -1;

  /// Observers see each contact's motion with its old and its new state.
  template <bool turns, bool commit, class ModelRef, class Observer>
  void sum_groups(ModelRef& model, const Trial& trial, BodyForces& sum, Observer& observer);
  template <bool turns, bool commit, class Group, class Observer>
  void sum_group(const GroupPlan& plan, Group& group, const contact::Placement& placement, const Trial& trial,
                 BodyForces& sum, Observer& observer);
  void add_foreign(BodyForces& sum) const;

  std::int64_t chunk_size_ = 0;
  bool turns_ = false;
  std::vector<GroupPlan> plans_;
  std::vector<std::int32_t> foreign_starts_;  ///< [bodies + 1] slots of a body
  std::vector<Vec3> foreign_force_;           ///< [slots]
  std::vector<Vec3> foreign_moment_;
};

/// Contact forces after a trial displacement. Nothing is stored in the contacts.
BodyForces contact_forces(const Model& model, const Displacement& displacement);

/// Contact forces of the model as it stands.
BodyForces contact_forces(const Model& model);

/// Elastic energy of all contacts after a trial displacement, J. Summed in chunks of contacts.
double elastic_energy(const Model& model, const Displacement& displacement);

/// Elastic energy of all contacts of the model as it stands, J.
double elastic_energy(const Model& model);

/// Force of the bodies on each wall of the model as it stands [walls], N.
std::vector<Vec3> wall_forces(const Model& model);

}  // namespace eigengrain::assembly
