#include "eigengrain/assembly/bonds.hpp"
#include "eigengrain/assembly/linear_system.hpp"
#include "eigengrain/assembly/loads.hpp"
#include "eigengrain/assembly/local_damping.hpp"
#include "eigengrain/assembly/selection.hpp"
#include "eigengrain/assembly/surroundings.hpp"
#include "eigengrain/assembly/unknowns.hpp"

#include "input.hpp"
#include "text.hpp"
#include "verbs.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <utility>

namespace eigengrain::app {
namespace {

using nlohmann::ordered_json;

/// What one group of contacts brings into the model.
struct GroupSummary {
  std::string kinematics;
  std::string law;
  std::int32_t rule = 0;
  std::int64_t contacts = 0;
  std::size_t history_bytes = 0;  ///< a contact; 0 where the law keeps no state
  bool needs_rotation = false;
  std::int64_t bonds = 0;  ///< that hold
  bool additive = false;   ///< whether its contacts are bonds beside those of another group
};

std::vector<GroupSummary> summarise(const assembly::Model& model) {
  std::vector<GroupSummary> result;
  const contact::Placement placement = model.placement();
  model.contacts.for_each_group([&](const auto& group) {
    using Group = std::decay_t<decltype(group)>;
    using State = typename Group::State;
    std::int64_t acting = 0;  // a state lists pairs that are only near, too
    for (std::size_t c = 0; c < group.pairs.size(); ++c)
      acting += static_cast<std::int64_t>(group.law.acts(
          contact::at_rest(Group::KinematicsType::geometry(placement, group.pairs[c])), group.states[c]));
    result.push_back({std::string(Group::KinematicsType::name), std::string(Group::LawType::name), group.rule,
                      acting, std::is_empty_v<State> ? 0 : sizeof(State), group.law.needs_rotation()});
    if constexpr (contact::BondLaw<typename Group::LawType>) {
      GroupSummary& summary = result.back();
      summary.bonds = std::count_if(group.states.begin(), group.states.end(),
                                    [](const State& state) { return state.bonded(); });
      summary.additive = Group::LawType::additive;
      if (!summary.additive) summary.law = contact::Linear::name;
    }
  });
  return result;
}

std::string rule_text(const model::Scene& scene, std::int32_t rule) {
  const model::ContactRule& r = scene.contacts[rule];
  const auto name = [&](std::int32_t material) {
    return material == model::ContactRule::any_material ? std::string("any") : scene.materials[material].name;
  };
  return fmt::format("contacts[{}] {}-{}", r.entry, name(r.first), name(r.second));
}

/// What the program could do and this scene does not ask for: none of it is stored or computed.
std::vector<std::string> left_out(const model::Scene& scene, const assembly::Model& model,
                                  const assembly::Unknowns& unknowns,
                                  const std::vector<GroupSummary>& groups) {
  std::vector<std::string> parts;
  const auto none = [&](auto has) { return std::none_of(groups.begin(), groups.end(), has); };
  const char* why = groups.empty() ? "nothing touches"
                    : none([](const GroupSummary& g) { return g.needs_rotation; })
                        ? "no contact has shear stiffness"
                        : "all are fixed";
  if (unknowns.rotations() == 0) parts.push_back(fmt::format("rotations ({})", why));
  if (none([](const GroupSummary& g) { return g.history_bytes > 0; }))
    parts.push_back(
        fmt::format("contact history ({})", groups.empty() ? "nothing touches" : "no law needs one"));
  if (!model.cell.any())
    parts.emplace_back("periodic images");
  else if (!model.cell.deforms())
    parts.emplace_back("motion of the cell");
  if (model.wall_count() == 0)
    parts.emplace_back("walls");
  else if (model.wall_motions.empty())
    parts.emplace_back("motion of walls");
  if (scene.gravity.isZero(0)) parts.emplace_back("gravity");
  if (!assembly::has_loads(model.bodies)) parts.emplace_back("applied loads");
  if (assembly::largest_damping(model) == 0) parts.emplace_back("damping");
  if (model.bodies.clumps.empty()) parts.emplace_back("clumps");
  return parts;
}

/// What one step of the explicit cycle has to do in this scene, in its order.
std::vector<std::string> passes(const model::Scene& scene, const assembly::Model& model,
                                const assembly::Unknowns& unknowns, const std::vector<GroupSummary>& groups) {
  std::vector<std::string> parts;
  const auto acts = [](const model::ContactRule& rule) { return rule.law != "none"; };
  if (std::any_of(scene.contacts.begin(), scene.contacts.end(), acts)) parts.emplace_back("search");
  for (const GroupSummary& g : groups)
    parts.push_back(fmt::format("{} {} {}forces", g.kinematics, g.law, g.additive ? "bond " : ""));
  if (!scene.gravity.isZero(0)) parts.emplace_back("gravity");
  if (assembly::has_loads(model.bodies)) parts.emplace_back("applied loads");
  if (assembly::largest_damping(model) > 0) parts.emplace_back("local damping");
  const auto moves = [](model::FixedComponents fixed) { return fixed.translation() != 7; };
  if (std::any_of(model.bodies.fixed.begin(), model.bodies.fixed.end(), moves))
    parts.emplace_back("translation");
  if (!model.wall_motions.empty()) parts.emplace_back("motion of walls");
  if (model.cell.deforms()) parts.emplace_back("motion of the cell");
  if (unknowns.rotations() > 0) parts.emplace_back("rotation");
  if (!model.bodies.clumps.empty()) parts.emplace_back("motion of clumps");
  if (!model.bodies.orientation.empty()) parts.emplace_back("orientation");
  if (!model.bodies.ramp.empty()) parts.emplace_back("growth");
  if (scene.mass_scaling) parts.emplace_back("mass scaling");
  return parts;
}

/// "set 2 keys, more balls, groups, 1 change of bodies, run, save".
std::string stage_text(const model::Stage& stage) {
  std::vector<std::string> parts;
  if (!stage.settings.empty()) parts.push_back("set " + counted(std::ssize(stage.settings), "key", "keys"));
  if (stage.adds_balls) parts.emplace_back("more balls");
  if (!stage.groups.empty()) parts.push_back(counted(std::ssize(stage.groups), "group", "groups"));
  if (!stage.bodies.empty())
    parts.push_back(counted(std::ssize(stage.bodies), "change of bodies", "changes of bodies"));
  if (!stage.contacts.empty())
    parts.push_back(counted(std::ssize(stage.contacts), "choice of contacts", "choices of contacts"));
  if (stage.run.any()) parts.emplace_back("run");
  if (stage.relax) parts.push_back(fmt::format("relax to {:g}", stage.relax->tolerance));
  if (!stage.save.empty()) parts.push_back("save " + stage.save);
  if (stage.repeat > 1) parts.push_back(fmt::format("{} times", grouped(stage.repeat)));
  return fmt::format("{}{}{}", stage.name, stage.name.empty() ? "" : ": ", fmt::join(parts, ", "));
}

void print_settings(const model::Scene& scene, const model::Bodies& bodies) {
  fmt::print("  damping     local, {:g}\n", scene.local_damping);
  if (const auto own = std::count_if(bodies.damping.begin(), bodies.damping.end(),
                                     [](double alpha) { return alpha != model::Bodies::scene_damping; });
      own > 0)
    fmt::print("  damping     of their own for {}; the largest counts for the timestep\n",
               counted(own, "ball", "balls"));
  if (scene.mass_scaling)
    fmt::print("  timestep    {:g} s, by {} scaling of masses\n", scene.mass_scaling->dt,
               model::name_of(scene.mass_scaling->form));
  else if (scene.timestep.dt)
    fmt::print("  timestep    fixed, {:g} s\n", *scene.timestep.dt);
  else
    fmt::print("  timestep    {}, safety {:g}\n", model::name_of(scene.timestep.policy),
               scene.timestep.safety);
  if (scene.run.steps) fmt::print("  run         {}\n", counted(*scene.run.steps, "step", "steps"));
  if (scene.run.time) fmt::print("  run         until t = {:g} s\n", *scene.run.time);
  if (scene.run.unbalanced)
    fmt::print("  run         until the unbalanced ratio is {:g}\n", *scene.run.unbalanced);
  if (scene.run.kinetic) fmt::print("  run         until the kinetic energy is {:g} J\n", *scene.run.kinetic);
  if (scene.run.wall_force)
    fmt::print("  run         until the force on {} is {:g} N\n", scene.run.wall_force->wall,
               scene.run.wall_force->at_least);
  for (std::size_t k = 0; k < scene.stages.size(); ++k)
    fmt::print("  stage {:<5} {}\n", k + 1, stage_text(scene.stages[k]));
}

/// All that the verb reports.
struct Report {
  Report(const model::Scene& asked, assembly::Model built)
      : scene(asked),
        model(std::move(built)),
        system(model),
        unknowns(system.unknowns),
        groups(summarise(model)),
        steps(passes(asked, model, unknowns, groups)),
        absent(left_out(asked, model, unknowns, groups)),
        free(static_cast<std::int64_t>(unknowns.free_components().size())),
        set_aside(static_cast<std::int64_t>(unknowns.set_aside().size())) {
    assembly::make_groups(model.bodies, scene.groups, chosen);
  }

  const model::Scene& scene;
  assembly::Model model;
  assembly::LinearSystem system;
  const assembly::Unknowns& unknowns;
  std::vector<GroupSummary> groups;
  std::vector<std::string> steps;
  std::vector<std::string> absent;
  std::int64_t free;  ///< numbers that are free to move
  std::int64_t set_aside;
  std::vector<model::Group> chosen;  ///< groups of balls
};

/// How many balls each group of the scene has at its start.
ordered_json group_sizes(const Report& report) {
  ordered_json sizes = ordered_json::object();
  for (const model::Group& group : report.chosen) sizes[group.name] = group.balls.size();
  return sizes;
}

ordered_json to_json(const Report& report) {
  ordered_json groups = ordered_json::array();
  for (const GroupSummary& g : report.groups)
    groups.push_back({{"kinematics", g.kinematics},
                      {"law", g.law},
                      {"rule", g.rule},
                      {"contacts", g.contacts},
                      {"bonds", g.bonds},
                      {"history_bytes", g.history_bytes}});
  return {{"bodies", report.model.bodies.size()},
          {"clumps", report.model.bodies.clumps.size()},
          {"walls", report.model.wall_count()},
          {"contacts", report.system.elements.size()},
          {"bonds", assembly::count_bonds(report.model)},
          {"unknowns", report.free},
          {"translations", report.unknowns.blocks() - report.unknowns.rotations()},
          {"rotations", report.unknowns.rotations()},
          {"set_aside", report.set_aside},
          {"groups", groups},
          {"passes", report.steps},
          {"groups_of_balls", group_sizes(report)},
          {"stages", report.scene.stages.size()},
          {"left_out", report.absent},
          {"notes", report.scene.notes}};
}

std::string radii_text(const model::Bodies& bodies) {
  const auto [least, most] = std::minmax_element(bodies.radius.begin(), bodies.radius.end());
  return *least == *most ? fmt::format("radius {:g} m", *least)
                         : fmt::format("radii {:g} to {:g} m", *least, *most);
}

void print(const Report& report) {
  fmt::print("{} is in order. The model will consist of\n", report.scene.name);
  fmt::print("  bodies      {}, {}\n", counted(report.model.bodies.size(), "ball", "balls"),
             radii_text(report.model.bodies));
  if (const model::Clumps& clumps = report.model.bodies.clumps; !clumps.empty())
    fmt::print("  clumps      {}, of {} of these balls\n", counted(clumps.size(), "clump", "clumps"),
               grouped(static_cast<std::int64_t>(clumps.member.size())));
  for (const model::Group& group : report.chosen)
    fmt::print("  group       {}, {}\n", group.name, counted(std::ssize(group.balls), "ball", "balls"));
  for (const std::string& wall : assembly::wall_names(report.model)) fmt::print("  wall        {}\n", wall);
  for (const GroupSummary& g : report.groups) {
    fmt::print(
        "  {}    {} {}, {} by {}, {}\n", g.additive ? "bonds   " : "contacts", grouped(g.contacts),
        g.kinematics, g.law, rule_text(report.scene, g.rule),
        g.history_bytes == 0 ? "no history" : fmt::format("{} bytes of history each", g.history_bytes));
    if (g.bonds > 0 && !g.additive) fmt::print("  bonds       {} of these contacts\n", grouped(g.bonds));
  }
  if (assembly::count_bonds(report.model) == 0 &&
      std::any_of(report.scene.contacts.begin(), report.scene.contacts.end(),
                  [](const model::ContactRule& rule) { return rule.bond.has_value(); }))
    fmt::print("  bonds       none: no two balls of a rule with bonds are within its gap\n");
  fmt::print("  unknowns    {}: {} of translation, {} of rotation (vectors)\n", grouped(report.free),
             grouped(report.unknowns.blocks() - report.unknowns.rotations()),
             grouped(report.unknowns.rotations()));
  if (report.set_aside > 0)
    fmt::print("  set aside   {} without acting contacts\n", counted(report.set_aside, "body", "bodies"));
  fmt::print("  passes      {}\n", fmt::join(report.steps, ", "));
  print_settings(report.scene, report.model.bodies);
  fmt::print("left out, as nothing here needs it: {}\n",
             report.absent.empty() ? "nothing" : fmt::format("{}", fmt::join(report.absent, ", ")));
  print_notes(report.scene);
}

}  // namespace

void check(const Options& options) {
  const Question question = read_question(options);
  const Report report(question.settings, question.model);
  write_json(options.json, to_json(report));
  print(report);
}

}  // namespace eigengrain::app
