#pragma once

#include "eigengrain/model/scene.hpp"

#include "diagnostics.hpp"
#include "section.hpp"

#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <set>
#include <string_view>
#include <utility>
#include <vector>

namespace eigengrain::io {

/// Where each ball stands: a file (by number) and a line, so that a million balls cost little.
struct BallPlaces {
  std::vector<std::string> files;
  std::vector<std::int32_t> file;  ///< index into files
  std::vector<std::int32_t> line;

  Place of(std::int32_t ball) const;
};

/// A scene whose bodies stay in one plane.
struct Plane2d {
  int normal = 2;      ///< axis across the plane
  bool disks = false;  ///< of unit thickness; else spheres
};

/// A scene while it is read, with the places that later checks name. A material of -1 stands for a name that
/// is unknown and has been reported.
struct SceneDraft {
  model::Scene scene;
  std::filesystem::path folder;  ///< that paths are relative to
  std::optional<Plane2d> planar;
  BallPlaces ball_places;
  std::vector<Place> material_places;
  std::vector<Place> contact_places;  ///< of the entries behind the rules
  std::vector<Place> wall_places;
  bool contacts_complete = true;             ///< no entry was left out because of a mistake
  bool balls_complete = true;                ///< neither was a ball
  bool walls_complete = true;                ///< nor a wall
  bool measures_complete = true;             ///< nor a region
  std::vector<model::Bodies> nodes;          ///< of each deformable body
  std::set<std::int32_t> materials_to_come;  ///< of balls that stages add
  bool wraps = true;            ///< balls into the cell, which may have moved since when they come in later
  std::int64_t repetition = 0;  ///< of the stage whose balls are read: adds to their seeds
};

/// One function for each section of the scene; each reads its own keys only. Those that use the materials
/// come after read_materials, read_balls and read_walls after read_periodic and read_planar, read_histories
/// after both and after read_measures.
void read_materials(const Section& root, SceneDraft& draft);
void read_periodic(const Section& root, SceneDraft& draft);
void read_planar(const Section& root, SceneDraft& draft);
void read_contacts(const Section& root, SceneDraft& draft);
void read_balls(const Section& root, SceneDraft& draft);
/// After read_balls.
void read_clumps(const Section& root, SceneDraft& draft);
void read_walls(const Section& root, SceneDraft& draft);
/// Without their nodes, which are no balls for any check.
void read_deformables(const Section& root, SceneDraft& draft);
/// Adds the nodes behind all bodies; a state has them already.
void append_nodes(SceneDraft& draft);
void read_gravity(const Section& root, SceneDraft& draft);
void read_damping(const Section& root, SceneDraft& draft);
void read_timestep(const Section& root, SceneDraft& draft);
/// After read_timestep.
void read_mass_scaling(const Section& root, SceneDraft& draft);
void read_run(const Section& root, SceneDraft& draft);
/// After read_walls.
void read_stages(const Section& root, SceneDraft& draft);
void read_measures(const Section& root, SceneDraft& draft);
void read_histories(const Section& root, SceneDraft& draft);
void read_outputs(const Section& root, SceneDraft& draft);

/// Balls of a list of entries as `balls`, into the draft.
void read_ball_entries(const std::vector<Section>& entries, SceneDraft& draft);

/// `run`, or that of a stage. After read_walls.
model::RunChoice read_end_of_run(const Section& section, const SceneDraft& draft);

/// What the stages ask for, tried out on the settings of the scene, `document`, which each of them changes
/// for those that follow.
void check_stages(const Section& root, const SceneDraft& draft, std::string_view document);

/// Index of the material that the key names; -1, after a report, if there is none, and -1 if the key is
/// absent.
std::int32_t read_material(const Section& section, std::string_view key, const model::Scene& scene);

/// Stands for a parameter that the entry of `contacts` leaves to the materials, until take_from_materials.
inline constexpr double left_to_materials = std::numeric_limits<double>::quiet_NaN();

/// Pairs of materials that can meet, the smaller index first.
std::set<std::pair<std::int32_t, std::int32_t>> meeting_pairs(const SceneDraft& draft);

/// Computes the parameters that entries of `contacts` leave to the materials: such a rule is replaced by one
/// for each pair of materials that it holds for and that can meet.
void take_from_materials(SceneDraft& draft, Diagnostics& diagnostics);

/// What only the whole scene can tell: materials without density, pairs without a law.
void check_scene(const Section& root, const SceneDraft& draft);

/// Where balls may start: not behind walls, no two at one place. Later they may be wherever forces put them.
void check_placement(const Section& root, const SceneDraft& draft);

/// What a cell that deforms cannot have: meshes, tables of the energy ledger, motion across a plane.
void check_deformation(const Section& root, const SceneDraft& draft);

/// The same of balls that come into a planar scene, whose plane is there along its normal (m).
void check_planar_balls(const SceneDraft& draft, double plane, Diagnostics& diagnostics);

/// Whether a planar scene is one: balls in one plane, nothing that drives them out of it.
void check_planar(const Section& root, const SceneDraft& draft);

/// Whether what masses may not be scaled with is absent: dashpots, a ledger. After take_from_materials.
void check_mass_scaling(const Section& root, const SceneDraft& draft);

/// Adds to the scene's notes what is odd, though it is no mistake: walls that coincide.
void add_notes(SceneDraft& draft);

}  // namespace eigengrain::io
