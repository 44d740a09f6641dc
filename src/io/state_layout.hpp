#pragma once

#include "eigengrain/assembly/state.hpp"
#include "eigengrain/contact/law.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <string>
#include <string_view>
#include <type_traits>

/// What stands where in a state file (docs/state-file.md), for the writer and the reader.
namespace eigengrain::io::layout {

inline constexpr std::string_view format = "eigengrain state";
/// Grows with every change after which an old reader would misunderstand a file.
inline constexpr std::int64_t schema = 4;
inline constexpr std::int64_t oldest_schema = 1;

/// The columns of bodies that are there only where some body has need of them, and that older programs do not
/// know.
template <class Bodies, class Visit>
void for_each_own_column(Bodies& balls, const Visit& visit) {
  visit("/bodies/applied_force", balls.applied_force);
  visit("/bodies/applied_moment", balls.applied_moment);
  visit("/bodies/damping", balls.damping);
  visit("/bodies/ramp", balls.ramp);
  visit("/bodies/mass_factor", balls.mass_factor);
}

/// Whether the periodic cell is not what the settings say.
inline bool cell_has_moved(const assembly::State& state) {
  const model::PeriodicCell& cell = state.model.cell;
  return cell.edges != state.settings.cell.edges || !cell.rate.isZero(0);
}

/// The least schema that says all of a state, so that older programs read what they understand: 2 with
/// clumps, 3 where bodies have loads, an α, a ramp of the radius or an inertial mass of their own, and where
/// the periodic cell has moved, 4 with deformable bodies, whose nodes are rows without radius.
inline std::int64_t schema_of(const assembly::State& state) {
  if (!state.model.solids.empty()) return 4;
  bool own = cell_has_moved(state);
  for_each_own_column(state.model.bodies,
                      [&](const char* /*path*/, const auto& column) { own = own || !column.empty(); });
  if (own) return 3;
  return state.model.bodies.clumps.empty() ? oldest_schema : 2;
}

inline const std::string root = "/";
inline const std::string settings = "/settings";
inline const std::string bodies = "/bodies";
inline const std::string position = "/bodies/position";
inline const std::string spin = "/bodies/spin";
inline const std::string orientation = "/bodies/orientation";
inline const std::string moment = "/bodies/moment";
inline const std::string clumps = "/clumps";
inline const std::string contacts = "/contacts";
inline const std::string list = "/neighbour_list";
inline const std::string ledger = "/ledger";
inline const std::string groups = "/groups";
inline const std::string progress = "/stages";
inline const std::string list_position = "/neighbour_list/position";
inline const std::string list_wall_lever = "/neighbour_list/wall_lever";
inline const std::string guard = "/step_guard";
inline const std::string cell = "/cell";
inline const std::string cell_edges = "/cell/edges";
inline const std::string cell_rate = "/cell/rate";
inline const std::string list_cell_edges = "/neighbour_list/cell_edges";
inline const std::string surfaces = "/surfaces";
inline const std::string deformables = "/deformables";
inline const std::string deformable_fingerprint = "/deformables/fingerprint";
inline const std::string deformable_first_node = "/deformables/first_node";
inline const std::string surface_fingerprint = "/surfaces/fingerprint";
inline const std::string walls = "/moving_walls";
inline const std::string wall_index = "/moving_walls/wall";
inline const std::string wall_centre = "/moving_walls/centre";
inline const std::string wall_orientation = "/moving_walls/orientation";

/// The columns with one row a body that every state has.
template <class State, class Visit>
void for_each_column(State& state, const Visit& visit) {
  auto& balls = state.model.bodies;
  visit("/bodies/identity", balls.identity);
  visit(position, balls.position);
  visit("/bodies/radius", balls.radius);
  visit("/bodies/mass", balls.mass);
  visit("/bodies/inertia", balls.inertia);
  visit("/bodies/material", balls.material);
  visit("/bodies/fixed", balls.fixed);
  visit("/bodies/velocity", balls.velocity);
  visit("/bodies/force", state.force);
}

/// The columns of the clumps, with as many rows as each has; only where there are clumps.
template <class Clumps, class Visit>
void for_each_clump_column(Clumps& all, const Visit& visit) {
  visit("/clumps/identity", all.identity);
  visit("/clumps/mass", all.mass);
  visit("/clumps/volume", all.volume);
  visit("/clumps/radius", all.radius);
  visit("/clumps/inertia", all.inertia);
  visit("/clumps/position", all.position);
  visit("/clumps/orientation", all.orientation);
  visit("/clumps/velocity", all.velocity);
  visit("/clumps/angular_momentum", all.angular_momentum);
  visit("/clumps/spin", all.spin);
  visit("/clumps/starts", all.starts);
  visit("/clumps/member", all.member);
  visit("/clumps/place", all.place);
}

/// The numbers of the root.
template <class State, class Visit>
void for_each_number(State& state, const Visit& visit) {
  visit("time", state.time);
  visit("step", state.step);
  visit("dt", state.dt);
  visit("next_dt", state.next_dt);
}

/// The numbers of a proof of the step.
template <class Guard, class Visit>
void for_each_guard_number(Guard& all, const Visit& visit) {
  visit("dt", all.dt);
  visit("wall_way", all.wall_way);
  visit("step", all.step);
  visit("gain", all.gain);
  visit("pause", all.pause);
  visit("last_pause", all.last_pause);
}

/// The columns of a proof of the step, with one row a body.
template <class Guard, class Visit>
void for_each_guard_column(Guard& all, const Visit& visit) {
  visit(guard + "/position", all.position);
  visit(guard + "/room", all.room);
  visit(guard + "/weight", all.weight);
}

/// How far the stages have come.
template <class Progress, class Visit>
void for_each_progress(Progress& all, const Visit& visit) {
  visit("stage", all.stage);
  visit("repetition", all.repetition);
  visit("begun", all.begun);
  visit("first_step", all.first_step);
  visit("first_time", all.first_time);
}

/// The numbers of an energy ledger.
template <class Ledger, class Visit>
void for_each_energy(Ledger& all, const Visit& visit) {
  visit("initial", all.initial);
  for (const assembly::EnergyIntegral& integral : assembly::energy_integrals)
    if constexpr (std::is_const_v<Ledger>)
      visit(std::string(integral.name), integral.of(all.integrals));
    else
      visit(std::string(integral.name), integral.in(all.integrals));
}

inline std::string group(std::int64_t k) {
  return fmt::format("{}/{}", contacts, k);
}

/// "shear_force normal": the datasets that hold the states of a group.
template <class Law>
std::string state_fields() {
  std::string names;
  for (const contact::StateField& field : Law::state_fields)
    names += fmt::format("{}{}", names.empty() ? "" : " ", field.name);
  return names;
}

}  // namespace eigengrain::io::layout
