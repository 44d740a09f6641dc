#pragma once

#include "eigengrain/base/vec.hpp"
#include "eigengrain/model/bodies.hpp"
#include "eigengrain/model/deformable.hpp"
#include "eigengrain/model/material.hpp"
#include "eigengrain/model/region.hpp"
#include "eigengrain/model/selection.hpp"
#include "eigengrain/model/stage.hpp"
#include "eigengrain/model/surface.hpp"
#include "eigengrain/model/surroundings.hpp"
#include "eigengrain/model/wall_motion.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

/// A scene is data: what the user asked for, in SI units, checked but not yet built.
namespace eigengrain::model {

/// Bonds that are made between the balls of a contact rule when a scene starts.
struct BondRule {
  std::string kind;                ///< a name of the table of bonds (contact/bonds.hpp)
  std::vector<double> parameters;  ///< in the order of the kind's own description; flags as 0 or 1
  double gap = 0;                  ///< surfaces that are no more than this apart are bonded, m
};

/// The law between two materials. An index of any_material matches every material.
struct ContactRule {
  static constexpr std::int32_t any_material = -1;

  std::int32_t first = any_material;   ///< index into Scene::materials
  std::int32_t second = any_material;  ///< index into Scene::materials
  std::string law;                     ///< a name of the law table (contact/law_table.hpp), or "none"
  /// In the order of the law's own description; flags as 0 or 1. Those at the end that have defaults may be
  /// left out.
  std::vector<double> parameters;
  std::optional<BondRule> bond{};
  std::int32_t entry = 0;  ///< of the scene file's `contacts`, for reports
  std::string name{};      ///< of an entry that holds only for contacts that a stage gives it; else empty

  bool by_choice() const { return !name.empty(); }
  bool matches(std::int32_t a, std::int32_t b) const {
    if (by_choice()) return false;
    const auto fits = [](std::int32_t mine, std::int32_t other) {
      return mine == any_material || mine == other;
    };
    return (fits(first, a) && fits(second, b)) || (fits(first, b) && fits(second, a));
  }
};

enum class TimestepPolicy { estimate, fixed, bound, tracked };

/// As scene files write it.
constexpr std::string_view name_of(TimestepPolicy policy) {
  switch (policy) {
    case TimestepPolicy::fixed:
      return "fixed";
    case TimestepPolicy::bound:
      return "bound";
    case TimestepPolicy::tracked:
      return "tracked";
    case TimestepPolicy::estimate:
      break;
  }
  return "estimate";
}

/// The fraction of its step that a policy takes where a scene does not say it.
constexpr double default_safety(TimestepPolicy policy) {
  return policy == TimestepPolicy::tracked ? 0.98 : 0.8;
}

struct TimestepChoice {
  TimestepPolicy policy = TimestepPolicy::estimate;
  double safety = 0.8;       ///< fraction of the estimate or bound in use
  std::optional<double> dt;  ///< s, with policy fixed
  std::int64_t every = 0;    ///< steps between looks at it; 0: as the policy thinks best
};

/// Inertial masses that are not the true ones, so that steps may be longer (PFC3D 1.7).
struct MassScaling {
  enum class Form {
    differential,  ///< of each body for itself
    uniform,       ///< of all by one factor
    selective      ///< of as few bodies, by as little, as the step needs; time stays what it is
  };
  Form form = Form::differential;
  double dt = 1;  ///< the step that the masses make stable, with TimestepChoice::safety, s
};
constexpr const char* name_of(MassScaling::Form form) {
  if (form == MassScaling::Form::selective) return "selective";
  return form == MassScaling::Form::uniform ? "uniform" : "differential";
}
/// Whether times and velocities mean what they say. Else only the steady state at the end means anything.
constexpr bool keeps_time(const std::optional<MassScaling>& scaling) {
  return !scaling || scaling->form == MassScaling::Form::selective;
}

/// A table that a run writes, a line every so many steps.
struct History {
  std::string file;                 ///< CSV, in the folder of results
  std::int64_t every = 1;           ///< steps
  bool energies = false;            ///< kinetic, elastic, gravitational
  bool unbalanced = false;          ///< mean and maximum of the ratio
  bool walls = false;               ///< force on each wall
  bool wall_moments = false;        ///< moment on each wall about its centre
  bool wall_positions = false;      ///< centre of each wall
  std::vector<std::int64_t> balls;  ///< identities: position, velocity, spin
  std::vector<Region> measures{};   ///< averages over each of these
  bool ledger = false;              ///< of energy
};

/// What else a run writes; 0: nothing of it.
struct OutputChoice {
  std::int64_t checkpoint_every = 10000;  ///< steps between states
  std::int64_t series_every = 0;          ///< steps between frames for ParaView
  bool series_stress = false;             ///< frames have the mean stress of each body
};

struct Scene {
  std::string name;  ///< of the file, for messages
  std::vector<Material> materials;
  std::vector<ContactRule> contacts;     ///< the first that matches a pair holds
  Bodies bodies;                         ///< in the order in which the scene names them
  std::vector<Plane> walls;              ///< where they start
  std::vector<Surface> surfaces;         ///< walls of triangles; numbered behind the planes
  std::vector<WallMotion> wall_motions;  ///< of walls that move
  std::vector<Deformable> deformables;   ///< their nodes stand in `bodies`, behind all balls
  PeriodicCell cell;
  Vec3 gravity = Vec3::Zero();  ///< m/s²
  double local_damping = 0.7;   ///< α of PFC3D's eq. 1.47, of bodies that have none of their own
  bool full_levers = false;     ///< levers of balls end at their surface, not at the contact point
  TimestepChoice timestep;
  std::optional<MassScaling> mass_scaling;
  RunChoice run;
  std::vector<GroupChoice> groups;  ///< made when the scene starts
  std::vector<Stage> stages;        ///< instead of `run`
  std::vector<Region> measures;
  std::vector<History> histories;
  OutputChoice outputs;
  std::string document;  ///< what the file and the overrides said, without the balls, as a scene document
  std::vector<std::string> notes;  ///< what the reader made, or found odd though it is no mistake

  /// Index into `contacts` of the rule for two materials, or -1.
  std::int32_t rule_for(std::int32_t material_a, std::int32_t material_b) const {
    for (std::size_t r = 0; r < contacts.size(); ++r)
      if (contacts[r].matches(material_a, material_b)) return static_cast<std::int32_t>(r);
    return -1;
  }
};

}  // namespace eigengrain::model
