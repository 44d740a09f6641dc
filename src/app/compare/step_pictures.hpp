#pragma once

#include "eigengrain/timestep/step_study.hpp"

#include "report/chart.hpp"
#include "report/page.hpp"

/// The pictures on the page of `compare steps`.
namespace eigengrain::app {

/// An error that runs are drawn by, as a part of something of its own kind.
struct Error {
  const char* name;
  double (*of)(const timestep::StepRun& run, const timestep::StepStudy& study);
  report::Look look;
};
inline constexpr Error trajectory_error{
    "trajectory",
    [](const timestep::StepRun& r, const timestep::StepStudy& s) { return r.trajectory / s.mean_radius; },
    {report::Mark::circle, report::colour::blue, true}};
inline constexpr Error end_error{
    "final state",
    [](const timestep::StepRun& r, const timestep::StepStudy& s) { return r.final_state / s.mean_radius; },
    {report::Mark::diamond, report::colour::green, true}};
inline constexpr Error energy_error{
    "energy balance",
    [](const timestep::StepRun& r, const timestep::StepStudy& s) { return r.energy / s.energy; },
    {report::Mark::square, report::colour::ink, false}};
inline constexpr Error restitution_error{
    "restitution",
    [](const timestep::StepRun& r, const timestep::StepStudy&) { return r.restitution; },
    {report::Mark::triangle, report::colour::vermilion, true}};

/// Errors against the step.
void add_error_picture(const timestep::StepStudy& study, report::Page& page);
/// Steps and seconds against the step.
void add_time_picture(const timestep::StepStudy& study, report::Page& page);

}  // namespace eigengrain::app
