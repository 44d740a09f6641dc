#include "eigengrain/measures/ball_union.hpp"

#include "read_fixed.hpp"
#include "scene_draft.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string_view>
#include <vector>

namespace eigengrain::io {
namespace {

/// The balls of an entry in its own frame.
struct Shape {
  std::vector<Vec3> at;
  std::vector<double> radius;
};

/// Mass properties of an entry: about `centre`, along `axes`, both in its own frame.
struct Properties {
  model::ClumpShape shape;
  Vec3 centre = Vec3::Zero();
  Quat axes = Quat::Identity();
};

std::optional<Shape> read_shape(const Section& entry) {
  Shape shape;
  const std::vector<Section> sections = entry.sections("balls");
  for (const Section& ball : sections) {
    ball.check_keys();
    const auto at = ball.vector("at");
    const auto radius = ball.quantity("radius");
    if (!at || !radius) continue;
    shape.at.push_back(*at);
    shape.radius.push_back(*radius);
  }
  if (entry.has("balls") && sections.empty())
    entry.report("balls", "none; a clump has at least one, e.g. \"- {at: [0, 0, 0], radius: 5 mm}\"");
  if (sections.empty() || shape.at.size() != sections.size()) return std::nullopt;
  for (std::size_t i = 0; i < shape.at.size(); ++i)
    for (std::size_t j = 0; j < shape.at.size(); ++j) {
      const double room = shape.radius[j] - shape.radius[i] - (shape.at[i] - shape.at[j]).norm();
      if (i == j || room < 0 || (room == 0 && shape.radius[i] == shape.radius[j] && i < j)) continue;
      sections[i].report(fmt::format("lies within balls[{}], so it adds nothing to the shape; remove it", j));
      return std::nullopt;
    }
  return shape;
}

/// A rigid body's moments are each at most the sum of the other two.
bool belong_to_a_body(const Vec3& inertia) {
  return 2 * inertia.maxCoeff() <= inertia.sum() * (1 + 1e-9);
}

/// What the scene gives of mass, centre and inertia; nothing, after a report, where it makes no sense.
bool check_given(const Section& entry, const std::optional<Vec3>& inertia) {
  const bool centre = entry.has("centre");
  if (centre != entry.has("inertia") || (centre && !entry.has("mass"))) {
    entry.report(centre ? "centre" : "inertia",
                 "mass, centre and inertia belong together; give all three, mass alone, or none, and they "
                 "follow from the balls");
    return false;
  }
  if (!inertia || belong_to_a_body(*inertia)) return true;
  entry.report("inertia", fmt::format("({:g}, {:g}, {:g}) kg m2 belong to no rigid body: the largest is more "
                                      "than the sum of the others; are the units right?",
                                      inertia->x(), inertia->y(), inertia->z()));
  return false;
}

/// From what is given, or from the union of the balls.
std::optional<Properties> properties_of(const Section& entry, const Shape& balls, double density,
                                        SceneDraft& draft) {
  const auto mass = entry.quantity("mass");
  const auto centre = entry.vector("centre");
  const auto inertia = entry.vector("inertia");
  if ((entry.has("mass") && !mass) || (entry.has("centre") && !centre) || (entry.has("inertia") && !inertia))
    return std::nullopt;
  if (!check_given(entry, inertia)) return std::nullopt;
  const measures::BallUnion body = measures::ball_union(balls.at, balls.radius);
  Properties result;
  result.shape.volume = body.volume;
  result.shape.radius = balls.radius;
  result.shape.mass = mass.value_or(density * body.volume);
  if (inertia) {
    result.centre = *centre;
    result.shape.inertia = *inertia;
  } else {
    const measures::PrincipalAxes axes =
        measures::principal_axes(result.shape.mass / body.volume * body.inertia);
    result.centre = body.centre;
    result.axes = axes.orientation;
    result.shape.inertia = axes.inertia;
    draft.scene.notes.push_back(
        fmt::format("{}: volume {:.6g} m3, mass {:.6g} kg, principal moments {:.6g}, {:.6g}, {:.6g} kg m2 of "
                    "the union of "
                    "its balls, to {:.0e}",
                    entry.path(), body.volume, result.shape.mass, axes.inertia[0], axes.inertia[1],
                    axes.inertia[2], body.error));
  }
  for (const Vec3& at : balls.at)
    result.shape.place.emplace_back(result.axes.conjugate() * (at - result.centre));
  return result;
}

class Instances {
 public:
  Instances(SceneDraft& draft, std::int32_t material, double damping)
      : draft_(draft), material_(material), damping_(damping) {}

  void add(const Section& section, const Properties& body) {
    section.check_keys();
    const auto position = section.vector("position");
    const auto axis = section.vector("axis");
    const auto angle = section.quantity("angle");
    const auto velocity = section.vector("velocity");
    const auto spin = section.vector("spin");
    const auto force = section.vector("force");
    const auto moment = section.vector("moment");
    const auto fixed = read_fixed_whole(section);
    if (!position || !axis || !angle || !velocity || !spin || !force || !moment || !fixed) return;
    if (!(axis->norm() > 0)) {
      section.report("axis", "[0, 0, 0] has no direction; give e.g. [0, 0, 1]");
      return;
    }
    const Quat turn(Eigen::AngleAxisd(*angle, axis->normalized()));
    model::ClumpStart start{.position = draft_.scene.cell.wrapped(*position),
                            .orientation = (turn * body.axes).normalized(),
                            .velocity = *velocity,
                            .spin = *spin,
                            .material = material_,
                            .fixed = *fixed,
                            .force = *force,
                            .moment = *moment,
                            .damping = damping_};
    model::add_clump(draft_.scene.bodies, body.shape, start);
    note_place(section.place(), body.shape.place.size());
  }

 private:
  /// All balls of an instance stand where the instance stands.
  void note_place(const Place& place, std::size_t balls) {
    BallPlaces& places = draft_.ball_places;
    if (places.files.empty() || places.files.back() != place.file) places.files.push_back(place.file);
    places.file.insert(places.file.end(), balls, static_cast<std::int32_t>(places.files.size()) - 1);
    places.line.insert(places.line.end(), balls, place.line);
  }
  /// Rotations of a clump are fixed all or none: fixing one would need the forces of the axle.
  static std::optional<model::FixedComponents> read_fixed_whole(const Section& section) {
    const model::FixedComponents fixed = read_fixed(section);
    if (fixed.rotation() == 0 || fixed.rotation() == 7) return fixed;
    section.report("fix",
                   "the rotation of a clump is fixed about all axes or about none; write wx, wy and wz");
    return std::nullopt;
  }

  SceneDraft& draft_;
  std::int32_t material_;
  double damping_;
};

void read_entry(const Section& entry, SceneDraft& draft) {
  if (entry.has("growth"))
    return entry.report(
        "growth",
        "of a clump; only the radii of single balls change. Leave it out, or make the body of "
        "balls with bonds");
  entry.check_keys();
  const std::int32_t material = read_material(entry, "material", draft.scene);
  const auto shape = read_shape(entry);
  const std::vector<Section> sections = entry.sections("instances");
  if (entry.has("instances") && sections.empty())
    entry.report("instances", "none; add e.g. \"- {position: [0, 0, 0]}\", or remove the entry");
  if (!shape) return;
  // Without a density the scene is refused later; until then any will do.
  const double density =
      material >= 0 ? draft.scene.materials[static_cast<std::size_t>(material)].density : 0.0;
  const auto body = properties_of(entry, *shape, density > 0 ? density : 1.0, draft);
  if (!body) return;
  if (!std::isnormal(body->shape.inertia.minCoeff()) || !std::isnormal(body->shape.mass))
    return entry.report(
        fmt::format("a mass of {} kg and moments down to {} kg m2 are no sizes for numbers; are "
                    "the units right?",
                    body->shape.mass, body->shape.inertia.minCoeff()));
  Instances instances(draft, material, read_own_damping(entry));
  for (const Section& section : sections) instances.add(section, *body);
}

}  // namespace

void read_clumps(const Section& root, SceneDraft& draft) {
  if (draft.planar && root.has("clumps"))
    return root.report("clumps",
                       "not in a planar scene: a clump turns about all axes or about none; leave out "
                       "planar, or make the bodies of balls with bonds");
  const std::int64_t mistakes_before = root.diagnostics().count();
  for (const Section& entry : root.sections("clumps")) read_entry(entry, draft);
  if (root.diagnostics().count() != mistakes_before) draft.balls_complete = false;
}

}  // namespace eigengrain::io
