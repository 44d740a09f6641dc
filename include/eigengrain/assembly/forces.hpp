#pragma once

#include "eigengrain/assembly/bond_break.hpp"
#include "eigengrain/assembly/model.hpp"
#include "eigengrain/assembly/moving_walls.hpp"
#include "eigengrain/assembly/solid.hpp"
#include "eigengrain/contact/dissipation.hpp"
#include "eigengrain/contact/skin.hpp"

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <type_traits>
#include <vector>

namespace eigengrain::assembly {

/// Displacement of every body since the committed state. Rotations may be empty: none.
struct Displacement {
  std::vector<Vec3> translation;  ///< [bodies] u, m
  std::vector<Vec3> rotation;     ///< [bodies] θ, rad; or empty
};

/// The orientations of bodies after rotations θ [bodies] (rad; or empty: none); empty where bodies have none.
std::vector<Quat> turned_orientations(const model::Bodies& bodies, std::span<const Vec3> rotation);

/// Where bodies are and how they came there from the committed state: by u = duration · velocity and
/// θ = duration · spin. The cycle passes its velocities and its step; displacements are velocities for a
/// duration of one.
struct Trial {
  std::span<const Vec3> position;  ///< [bodies] committed position + u, m
  std::span<const Vec3> velocity;  ///< [bodies]
  std::span<const Vec3> spin;      ///< [bodies]; or empty: nothing turns
  double duration = 1;
  std::span<const Quat> orientation{};  ///< [bodies] turned by θ; or empty where nothing asks for it
  double per_second = 0;  ///< 1/Δt of a step in time; 0: nothing moves in time, and dashpots do nothing
  const WallStep* walls = nullptr;  ///< how walls moved; null: all stand still
  /// By how much the edges of the periodic cell changed, m: images move apart with it; null: the cell rests.
  const Mat3* cell_step = nullptr;

  contact::SideMotion side(std::int32_t body) const {
    const auto i = static_cast<std::size_t>(body);
    return {duration * velocity[i], spin.empty() ? Vec3(Vec3::Zero()) : Vec3(duration * spin[i])};
  }
  /// Of the image of a body, which moves with the cell as well.
  contact::SideMotion side(std::int32_t body, const model::Image& image) const {
    contact::SideMotion motion = side(body);
    if (cell_step != nullptr) motion.translation += *cell_step * Vec3(image[0], image[1], image[2]);
    return motion;
  }
};

/// Where the sides of contacts are in a trial state.
inline contact::Placement placement_in(const Model& model, const Trial& trial) {
  contact::Placement placement = model.placement(trial.position, trial.orientation);
  if (trial.walls != nullptr) {
    placement.middle_walls = trial.walls->middle;
    placement.middle_surfaces = trial.walls->middle_surfaces;
  }
  return placement;
}

/// The motion of a contact in a trial state, as its law wants it.
template <class Kinematics, class Law>
contact::MotionOf<Law> motion_in(const Law& law, const contact::Placement& placement, const Trial& trial,
                                 const contact::Pair& pair, const contact::ContactGeometry& geometry) {
  contact::SideMotion second;
  if constexpr (Kinematics::second_is_body)
    second = trial.side(pair.b, pair.image);
  else if (contact::on_skin<Kinematics>(placement, pair))
    second = contact::skin_point(placement, pair).motion(trial.velocity, trial.duration);
  else if (trial.walls != nullptr)
    second = trial.walls->side[static_cast<std::size_t>(Kinematics::wall(placement, pair))];
  contact::MotionOf<Law> motion =
      contact::motion_for<Kinematics>(law, placement, pair, geometry, trial.side(pair.a), second);
  if constexpr (contact::asks_rate<Law>) {
    motion.velocity = trial.per_second * motion.displacement;
    motion.reduced_mass = contact::reduced_mass<Kinematics>(placement, pair);
  }
  return motion;
}

/// What the contacts exert on every body: force (N) and moment about its centre (N m).
struct BodyForces {
  std::vector<Vec3> force;
  std::vector<Vec3> moment;  ///< empty where nothing turns
};

namespace kernel {
struct BodyPlace;
struct BodyMotion;
struct BodySum;
struct Candidate;
}  // namespace kernel

/// The sum of the forces of contacts and of elements on every body, for one contact graph: the work of the
/// explicit cycle and of a residual. Threads share fixed chunks of bodies; a contact is evaluated once, in
/// the chunk of its first body, and what it does to a body of another chunk is kept and added in the end. So
/// every sum has one order (the order of the contacts), and the result is the same to the bit on any number
/// of threads. Nothing is allocated in a steady state. Cost O(contacts).
class ContactForceSum {
 public:
  /// turns  whether moments are wanted
  ContactForceSum(const Model& model, bool turns);
  ~ContactForceSum();
  ContactForceSum(ContactForceSum&&) noexcept;
  ContactForceSum& operator=(ContactForceSum&&) noexcept;

  /// Forces after a trial displacement. Nothing is stored in the contacts: the same call with the same
  /// displacement gives the same forces.
  void evaluate(const Model& model, const Trial& trial, BodyForces& sum);
  /// The same, and the contacts remember: the trial displacement becomes the committed state. What they
  /// dissipate on the way is added to `dissipated` if it is given; if not, it is not computed. Contacts of
  /// balls are evaluated several at a time (src/assembly/force_kernel.hpp), so that forces agree with those
  /// of evaluate() to rounding. Between two calls nobody else may change the states of contacts, nor
  /// the edges of the cell but as the trial says.
  void advance(Model& model, const Trial& trial, BodyForces& sum, contact::Dissipation* dissipated = nullptr);

  /// Bonds that broke in the last `advance`, in the order of the contacts; steps, times and
  /// entries are left to note_breaks.
  std::span<const BondBreak> broken() const { return broken_; }

 private:
  /// A group's contacts by chunk of their first body, and where each puts its force on a body elsewhere.
  struct GroupPlan {
    std::vector<std::int64_t> starts;  ///< [chunks + 1]
    std::vector<std::int32_t> slot;    ///< [contacts] into foreign_, or own_chunk; empty for walls
    std::vector<std::array<std::int32_t, 3>>
        skin_slot;  ///< [contacts] of corners that are bodies; empty without skins
    /// [chunks] those that a kernel evaluates, as of the last selection; empty for scalar loops
    std::vector<std::vector<kernel::Candidate>> candidates;
    std::vector<std::vector<BondBreak>> broken;  ///< [chunks] in the last advance; empty where nothing breaks
  };
  /// The bodies whose sums are at hand.
  struct Chunk {
    std::int64_t index;
    std::int64_t first_body;
    kernel::BodySum* sums;  ///< [bodies of the chunk]
  };

  /// Where the sides of contacts are, with the skins of solids at the trial positions.
  contact::Placement placement(const Model& model, const Trial& trial, const model::Facets& facets);
  template <bool commit, class ModelRef>
  void sum_groups(ModelRef& model, const contact::Placement& placement, const Trial& trial, BodyForces& sum);
  template <bool commit, class Group>
  void sum_group(GroupPlan& plan, Group& group, const Model& model, const contact::Placement& placement,
                 const Trial& trial, const Chunk& chunk);
  template <bool commit, class Group>
  void sum_one_by_one(GroupPlan& plan, Group& group, const model::Bodies& bodies,
                      const contact::Placement& placement, const Trial& trial, const Chunk& chunk);
  void pack_bodies(const Model& model, const Trial& trial);
  template <class Group>
  void select_candidates(GroupPlan& plan, const Group& group, const Model& model, const Chunk& chunk);
  void add_foreign(BodyForces& sum) const;
  /// Decides which triangles of surfaces are contacts.
  void follow_facets(Model& model, const contact::Placement& placement) const;

  std::int64_t chunk_size_ = 0;
  bool turns_ = false;
  std::vector<GroupPlan> plans_;
  std::vector<std::int32_t> foreign_starts_;  ///< [bodies + 1] slots of a body
  std::vector<kernel::BodySum> foreign_;      ///< [slots]
  std::vector<kernel::BodyPlace> places_;     ///< [bodies] or empty: no kernel asks
  std::vector<kernel::BodyMotion> motions_;   ///< the same
  std::vector<double> ways_;                  ///< [chunks] of pack_bodies
  double margin_ = 0;                         ///< gap up to which contacts are candidates, m
  double way_ =
      std::numeric_limits<double>::infinity();  ///< by which two may be nearer than at the last selection, m
  bool selects_ = true;                         ///< in this call
  std::vector<BondBreak> broken_;
  SolidForces of_elements_;
  model::Facets trial_facets_;   ///< where there are solids
  model::Facets middle_facets_;  ///< the same in the middle of the step
};

/// Finds the forces of a state anew from where everything is, as of contacts that stand still: springs keep
/// their history, dashpots forget the last step.
void renew_forces(State& state);

/// Contact forces after a trial displacement. Nothing is stored in the contacts.
BodyForces contact_forces(const Model& model, const Displacement& displacement);

/// Contact forces of the model as it stands.
BodyForces contact_forces(const Model& model);

/// Elastic energy of all contacts after a trial displacement, J. Summed in chunks of contacts.
double elastic_energy(const Model& model, const Displacement& displacement);

/// Elastic energy of all contacts of the model as it stands, J.
double elastic_energy(const Model& model);

/// What the bodies exert on a wall: force (N) and moment about its centre (N m); with what dashpots did in
/// the step that led there.
struct WallLoad {
  Vec3 force = Vec3::Zero();
  Vec3 moment = Vec3::Zero();
};

/// Load on each wall of the model as it stands [walls].
std::vector<WallLoad> wall_loads(const Model& model);

/// Force of the bodies on each wall of the model as it stands [walls], N.
std::vector<Vec3> wall_forces(const Model& model);

}  // namespace eigengrain::assembly
