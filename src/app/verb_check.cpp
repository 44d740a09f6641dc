#include "eigengrain/assembly/stiffness.hpp"
#include "eigengrain/assembly/unknowns.hpp"
#include "eigengrain/io/scene_reader.hpp"

#include "text.hpp"
#include "verbs.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <algorithm>

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
};

std::vector<GroupSummary> summarise(const contact::Contacts& contacts) {
  std::vector<GroupSummary> result;
  contacts.for_each_group([&](const auto& group) {
    using Group = std::decay_t<decltype(group)>;
    using State = typename Group::State;
    result.push_back({std::string(Group::KinematicsType::name), std::string(Group::LawType::name), group.rule,
                      group.size(), std::is_empty_v<State> ? 0 : sizeof(State)});
  });
  return result;
}

std::string rule_text(const model::Scene& scene, std::int32_t rule) {
  const model::ContactRule& r = scene.contacts[static_cast<std::size_t>(rule)];
  const auto name = [&](std::int32_t material) {
    return material == model::ContactRule::any_material
               ? std::string("any")
               : scene.materials[static_cast<std::size_t>(material)].name;
  };
  return fmt::format("contacts[{}] {}-{}", rule, name(r.first), name(r.second));
}

/// What the program could do and this scene does not ask for: none of it is stored or computed.
std::vector<std::string> left_out(const model::Scene& scene, const assembly::Model& model,
                                  const assembly::Unknowns& unknowns,
                                  const std::vector<GroupSummary>& groups) {
  std::vector<std::string> parts;
  if (unknowns.rotations() == 0) parts.emplace_back("rotations (no contact has shear stiffness)");
  if (std::all_of(groups.begin(), groups.end(), [](const GroupSummary& g) { return g.history_bytes == 0; }))
    parts.emplace_back("contact history (no law needs one)");
  if (!model.cell.any()) parts.emplace_back("periodic images");
  if (model.walls.empty()) parts.emplace_back("walls");
  if (scene.gravity.isZero(0)) parts.emplace_back("gravity");
  if (scene.local_damping == 0) parts.emplace_back("damping");
  return parts;
}

const char* policy_name(model::TimestepPolicy policy) {
  switch (policy) {
    case model::TimestepPolicy::fixed:
      return "fixed";
    case model::TimestepPolicy::bound:
      return "bound";
    case model::TimestepPolicy::estimate:
      break;
  }
  return "estimate";
}

void print_settings(const model::Scene& scene) {
  fmt::print("  damping     local, {:g}\n", scene.local_damping);
  if (scene.timestep.dt)
    fmt::print("  timestep    fixed, {:g} s\n", *scene.timestep.dt);
  else
    fmt::print("  timestep    {}, safety {:g}\n", policy_name(scene.timestep.policy), scene.timestep.safety);
  if (scene.run.steps) fmt::print("  run         {}\n", counted(*scene.run.steps, "step", "steps"));
  if (scene.run.unbalanced)
    fmt::print("  run         until the unbalanced ratio is {:g}\n", *scene.run.unbalanced);
}

}  // namespace

void check(const Options& options) {
  const model::Scene scene = io::read_scene(options.scene, options.overrides);
  const assembly::Model model = assembly::build_model(scene);
  const std::vector<contact::ContactElement> elements = assembly::contact_elements(model);
  const assembly::Unknowns unknowns(model.bodies, elements);
  const std::vector<GroupSummary> groups = summarise(model.contacts);
  const std::vector<std::string> absent = left_out(scene, model, unknowns, groups);
  const auto free = static_cast<std::int64_t>(unknowns.free_components().size());
  const auto [least, most] = std::minmax_element(model.bodies.radius.begin(), model.bodies.radius.end());

  ordered_json group_list = ordered_json::array();
  for (const GroupSummary& g : groups)
    group_list.push_back({{"kinematics", g.kinematics},
                          {"law", g.law},
                          {"rule", g.rule},
                          {"contacts", g.contacts},
                          {"history_bytes", g.history_bytes}});
  write_json(options.json, {{"bodies", model.bodies.size()},
                            {"walls", model.walls.size()},
                            {"contacts", model.contacts.size()},
                            {"unknowns", free},
                            {"translations", unknowns.blocks() - unknowns.rotations()},
                            {"rotations", unknowns.rotations()},
                            {"set_aside", unknowns.set_aside().size()},
                            {"groups", group_list},
                            {"left_out", absent}});

  fmt::print("{} is in order. The model will consist of\n", options.scene);
  fmt::print("  bodies      {}, radii {:g} to {:g} m\n", counted(model.bodies.size(), "ball", "balls"),
             *least, *most);
  for (const model::Plane& wall : model.walls) fmt::print("  wall        {}\n", wall.name);
  for (const GroupSummary& g : groups)
    fmt::print(
        "  contacts    {} {}, {} by {}, {}\n", grouped(g.contacts), g.kinematics, g.law,
        rule_text(scene, g.rule),
        g.history_bytes == 0 ? "no history" : fmt::format("{} bytes of history each", g.history_bytes));
  fmt::print("  unknowns    {}: {} of translation, {} of rotation (vectors)\n", grouped(free),
             grouped(unknowns.blocks() - unknowns.rotations()), grouped(unknowns.rotations()));
  if (!unknowns.set_aside().empty())
    fmt::print("  set aside   {} without acting contacts\n",
               counted(static_cast<std::int64_t>(unknowns.set_aside().size()), "ball", "balls"));
  print_settings(scene);
  fmt::print("left out, as nothing here needs it: {}\n",
             absent.empty() ? "nothing" : fmt::format("{}", fmt::join(absent, ", ")));
}

}  // namespace eigengrain::app
