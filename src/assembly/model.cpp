#include "eigengrain/assembly/model.hpp"

#include "eigengrain/base/error.hpp"
#include "eigengrain/search/candidates.hpp"

#include <fmt/format.h>

#include <optional>

namespace eigengrain::assembly {
namespace {

using contact::AnyGroup;
using contact::ContactGroup;
using contact::Pair;

/// The group for a rule: the first type of the law table that bears the name and serves the parameters.
template <class Kinematics>
std::optional<AnyGroup> new_group(const model::ContactRule& rule, std::int32_t index) {
  std::optional<AnyGroup> group;
  for_each_type(contact::LawTypes{}, [&](auto tag) {
    using Law = typename decltype(tag)::type;
    if (group || Law::name != rule.law) return;
    if (rule.parameters.size() != Law::parameters.size())
      throw InputError(fmt::format("contacts[{}]: {} parameters; the law \"{}\" takes {}", index,
                                   rule.parameters.size(), Law::name, Law::parameters.size()));
    if (Law::serves(rule.parameters))
      group = ContactGroup<Kinematics, Law>{Law::from_values(rule.parameters), index, {}, {}};
  });
  return group;
}

/// Rule for each pair of materials, looked up once: [materials × materials], -1 where none.
class RuleTable {
 public:
  explicit RuleTable(const model::Scene& scene) : materials_(scene.materials.size()) {
    for (std::size_t a = 0; a < materials_; ++a)
      for (std::size_t b = 0; b < materials_; ++b)
        rules_.push_back(scene.rule_for(static_cast<std::int32_t>(a), static_cast<std::int32_t>(b)));
  }
  std::int32_t operator()(std::int32_t a, std::int32_t b) const {
    return rules_[static_cast<std::size_t>(a) * materials_ + static_cast<std::size_t>(b)];
  }

 private:
  std::size_t materials_;
  std::vector<std::int32_t> rules_;
};

/// Adds a pair that may touch to its group, if its law says that it acts.
template <class Group>
void add_if_acting(Group& group, const contact::Placement& placement, const Pair& pair) {
  using Kinematics = typename Group::KinematicsType;
  const contact::ContactMotion motion = contact::at_rest(Kinematics::geometry(placement, pair));
  if (!group.law.acts(motion, typename Group::State{})) return;
  group.pairs.push_back(pair);
  group.states.push_back(group.law.formed(motion.normal));
}

/// Sorts pairs into the groups of their rules: one group a rule that any pair meets.
template <class Kinematics>
class Grouping {
 public:
  Grouping(const model::Scene& scene, const Model& model)
      : scene_(scene), placement_(model.placement()), rule_of_(scene), groups_(scene.contacts.size()) {}

  void add(const Pair& pair, std::int32_t material_a, std::int32_t material_b) {
    const std::int32_t rule = rule_of_(material_a, material_b);
    if (rule < 0) throw InputError(missing_rule(material_a, material_b));
    const model::ContactRule& wanted = scene_.contacts[rule];
    if (wanted.law == "none") return;
    std::optional<AnyGroup>& group = groups_[rule];
    if (!group) group = new_group<Kinematics>(wanted, rule);
    if (!group) throw InputError(fmt::format("contacts[{}]: there is no law \"{}\"", rule, wanted.law));
    std::visit([&](auto& concrete) { add_if_acting(concrete, placement_, pair); }, *group);
  }

  void move_into(contact::Contacts& contacts) {
    for (std::optional<AnyGroup>& group : groups_) {
      const bool empty = !group || std::visit([](const auto& g) { return g.pairs.empty(); }, *group);
      if (!empty) contacts.groups.push_back(std::move(*group));
    }
  }

 private:
  std::string missing_rule(std::int32_t a, std::int32_t b) const {
    const auto name = [&](std::int32_t m) { return scene_.materials[m].name; };
    return fmt::format("no entry of contacts matches {} and {}, which touch; add one with between: [{}, {}]",
                       name(a), name(b), name(a), name(b));
  }

  const model::Scene& scene_;
  contact::Placement placement_;
  RuleTable rule_of_;
  std::vector<std::optional<AnyGroup>> groups_;
};

void find_ball_ball(const model::Scene& scene, Model& model) {
  const model::Bodies& bodies = model.bodies;
  Grouping<contact::BallBall> grouping(scene, model);
  for (const search::CandidatePair& found :
       search::candidate_pairs(bodies.position, bodies.radius, model.cell)) {
    const auto a = static_cast<std::size_t>(found.a);
    const auto b = static_cast<std::size_t>(found.b);
    if (bodies.position[b] + model.cell.shift(found.image) == bodies.position[a])
      throw InputError(fmt::format("balls {} and {} have the same centre ({}, {}, {}); move one of them",
                                   bodies.identity[a], bodies.identity[b], bodies.position[a].x(),
                                   bodies.position[a].y(), bodies.position[a].z()));
    grouping.add({found.a, found.b, found.image}, bodies.material[a], bodies.material[b]);
  }
  grouping.move_into(model.contacts);
}

void find_ball_wall(const model::Scene& scene, Model& model) {
  const model::Bodies& bodies = model.bodies;
  Grouping<contact::BallPlane> grouping(scene, model);
  for (std::int32_t i = 0; i < bodies.size(); ++i) {
    const auto ball = static_cast<std::size_t>(i);
    for (std::size_t w = 0; w < model.walls.size(); ++w) {
      const model::Plane& wall = model.walls[w];
      if ((bodies.position[ball] - wall.point).dot(wall.normal) > bodies.radius[ball]) continue;
      grouping.add({i, static_cast<std::int32_t>(w), {}}, bodies.material[ball], wall.material);
    }
  }
  grouping.move_into(model.contacts);
}

}  // namespace

Model build_model(const model::Scene& scene) {
  Model model{.bodies = scene.bodies,
              .walls = scene.walls,
              .cell = scene.cell,
              .gravity = scene.gravity,
              .local_damping = scene.local_damping,
              .contacts = {}};
  model::sort_along_curve(model.bodies);
  find_ball_ball(scene, model);
  find_ball_wall(scene, model);
  return model;
}

}  // namespace eigengrain::assembly
