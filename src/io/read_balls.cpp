#include "packing_reader.hpp"
#include "scene_draft.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>

namespace eigengrain::io {
namespace {

/// What an entry of `balls` says of all its balls.
struct BallKind {
  std::int32_t material = -1;
  model::FixedComponents fixed;
  Vec3 velocity;  ///< m/s
  Vec3 spin;      ///< rad/s
};

model::FixedComponents read_fixed(const Section& section) {
  static constexpr std::array<std::string_view, 6> components{"x", "y", "z", "wx", "wy", "wz"};
  model::FixedComponents fixed;
  for (const std::string& word : section.texts("fix").value_or(std::vector<std::string>())) {
    if (word == "all") return model::FixedComponents(63);
    for (int k = 0; k < 6; ++k)
      if (components[k] == word) fixed.fix(k);
  }
  return fixed;
}

/// Adds the next row to a column that is there only if some ball needs it; rows before are zero.
void add_row(std::vector<Vec3>& column, std::int32_t row, const Vec3& value) {
  if (column.empty() && value == Vec3::Zero()) return;
  column.resize(static_cast<std::size_t>(row), Vec3::Zero());
  column.push_back(value);
}

/// Adds balls to the draft, and remembers where each stands.
class BallList {
 public:
  BallList(SceneDraft& draft, Diagnostics& diagnostics) : draft_(draft), diagnostics_(diagnostics) {}

  void begin_file(const std::string& name) { draft_.ball_places.files.push_back(name); }

  void add(const Vec3& position, double radius, const BallKind& kind, std::int32_t line) {
    model::Bodies& bodies = draft_.scene.bodies;
    if (bodies.position.size() == std::numeric_limits<std::int32_t>::max()) return report_too_many(line);
    const double mass = model::sphere_mass(radius, density(kind.material));
    const double inertia = model::sphere_inertia(radius, mass);
    if (!std::isnormal(inertia) && density(kind.material) > 0) report_size(radius, mass, line);
    add_row(bodies.velocity, bodies.size(), kind.velocity);
    add_row(bodies.spin, bodies.size(), kind.spin);
    bodies.identity.push_back(bodies.size());
    bodies.position.push_back(draft_.scene.cell.wrapped(position));
    bodies.radius.push_back(radius);
    bodies.mass.push_back(mass);
    bodies.inertia.push_back(inertia);
    bodies.material.push_back(kind.material);
    bodies.fixed.push_back(kind.fixed);
    draft_.ball_places.file.push_back(static_cast<std::int32_t>(draft_.ball_places.files.size()) - 1);
    draft_.ball_places.line.push_back(line);
  }

 private:
  double density(std::int32_t material) const {
    return material < 0 ? 1.0 : draft_.scene.materials[material].density;
  }

  void report_size(double radius, double mass, std::int32_t line) {
    diagnostics_.add(
        {draft_.ball_places.files.back(), line},
        fmt::format("radius {} m makes a mass of {} kg, which is no size for a number; are the units right?",
                    radius, mass),
        "mass");
  }

  void report_too_many(std::int32_t line) {
    diagnostics_.add({draft_.ball_places.files.back(), line}, "more than 2,147,483,647 balls",
                     "too many balls");
  }

  SceneDraft& draft_;
  Diagnostics& diagnostics_;
};

void read_packing(const Section& section, const BallKind& kind, SceneDraft& draft, BallList& balls) {
  for (const std::string_view key : {"position", "radius"})
    if (section.has(key))
      section.report(key, "not beside file: the packing file gives it; remove one of the two");
  const auto name = section.text("file");
  if (!name) return;
  const std::filesystem::path file = (draft.folder / *name).lexically_normal();
  Diagnostics& diagnostics = section.diagnostics();
  const Packing packing = read_packing_file(file, section.place("file"), diagnostics);
  balls.begin_file(file.string());
  for (std::size_t k = 0; k < packing.radius.size(); ++k)
    balls.add(packing.position[k], packing.radius[k], kind, packing.line[k]);
}

void read_single(const Section& section, const BallKind& kind, BallList& balls) {
  const auto position = section.vector("position");
  const auto radius = section.quantity("radius");
  if (!section.has("radius")) section.report_missing("radius");
  if (!position || !radius) return;
  const Place place = section.place();
  balls.begin_file(place.file);
  balls.add(*position, *radius, kind, place.line);
}

}  // namespace

Place BallPlaces::of(std::int32_t ball) const {
  const auto b = static_cast<std::size_t>(ball);
  return {files[static_cast<std::size_t>(file[b])], line[b]};
}

void read_balls(const Section& root, SceneDraft& draft) {
  Diagnostics& diagnostics = root.diagnostics();
  const std::int64_t mistakes_before = diagnostics.count();
  BallList balls(draft, diagnostics);
  for (const Section& section : root.sections("balls")) {
    section.check_keys();
    const BallKind kind{.material = read_material(section, "material", draft.scene),
                        .fixed = read_fixed(section),
                        .velocity = section.vector("velocity").value_or(Vec3::Zero()),
                        .spin = section.vector("spin").value_or(Vec3::Zero())};
    if (section.has("file"))
      read_packing(section, kind, draft, balls);
    else if (section.has("position"))
      read_single(section, kind, balls);
    else
      section.report(
          "neither file nor position; add e.g. \"file: packing.txt\", or \"position: [0, 0, 0]\" and "
          "\"radius: 5 mm\"");
  }
  if (root.has("balls") && draft.scene.bodies.size() == 0 && diagnostics.count() == mistakes_before)
    root.report("balls", "no balls; add e.g. \"- {position: [0, 0, 0], radius: 5 mm, material: grain}\"");
  draft.balls_complete = diagnostics.count() == mistakes_before;
}

}  // namespace eigengrain::io
