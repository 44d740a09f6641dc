#include "ball_list.hpp"
#include "packing_reader.hpp"
#include "read_fixed.hpp"
#include "read_generated.hpp"
#include "scene_draft.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <optional>
#include <string_view>
#include <vector>

namespace eigengrain::io {
namespace {

/// A sort of entry: the key that makes it one, and the keys that it takes beside those of all entries.
struct EntrySort {
  std::string_view key;
  std::vector<std::string_view> takes;
};

/// An entry is of the first sort whose key it has.
const std::vector<EntrySort>& entry_sorts() {
  static const std::vector<EntrySort> sorts{
      {"file", {"format"}},
      {"position", {"radius"}},
      {"lattice", {"radius", "spacing", "overlap", "box"}},
      {"fill", {"radius", "sizes", "fraction", "mean_overlap", "seed", "box"}},
  };
  return sorts;
}

/// Reports the keys that belong to other sorts of entries.
void check_sort(const Section& section, const EntrySort& mine) {
  std::vector<std::string_view> reported;
  const auto check = [&](std::string_view key) {
    const auto among = [key](const std::vector<std::string_view>& keys) {
      return std::find(keys.begin(), keys.end(), key) != keys.end();
    };
    if (key == mine.key || among(mine.takes) || among(reported) || !section.has(key)) return;
    reported.push_back(key);
    if (mine.key == "file" && (key == "position" || key == "radius"))
      section.report(key, "not beside file: the packing file gives it; remove one of the two");
    else
      section.report(key, fmt::format("not beside {}, which takes {}; remove one of the two", mine.key,
                                      fmt::join(mine.takes, ", ")));
  };
  for (const EntrySort& sort : entry_sorts()) {
    check(sort.key);
    for (const std::string_view key : sort.takes) check(key);
  }
}

void read_packing(const Section& section, const BallKind& kind, SceneDraft& draft, BallList& balls) {
  const auto name = section.text("file");
  const auto format = section.has("format") ? section.text("format") : std::string();
  if (!name || !format) return;
  const std::filesystem::path file = (draft.folder / *name).lexically_normal();
  Diagnostics& diagnostics = section.diagnostics();
  const Packing packing =
      read_packing_file(file, section.place("file"), diagnostics, find_packing_format(*format));
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

std::optional<model::RadiusRamp> read_growth(const Section& entry) {
  const auto section = entry.section("growth");
  if (!section) return std::nullopt;
  section->check_keys();
  const auto factor = section->quantity("factor");
  const auto over = section->quantity("over");
  const auto from = section->quantity("from");
  if (!factor || !over || !from || *factor == 1) return std::nullopt;
  return model::RadiusRamp{.factor = *factor, .from = *from, .over = *over};
}

void read_entry(const Section& section, SceneDraft& draft, BallList& balls) {
  section.check_keys();
  const BallKind kind{.material = read_material(section, "material", draft.scene),
                      .fixed = read_fixed(section),
                      .velocity = section.vector("velocity").value_or(Vec3::Zero()),
                      .spin = section.vector("spin").value_or(Vec3::Zero()),
                      .force = section.vector("force").value_or(Vec3::Zero()),
                      .moment = section.vector("moment").value_or(Vec3::Zero()),
                      .damping = read_own_damping(section),
                      .growth = read_growth(section)};
  const auto& sorts = entry_sorts();
  const auto sort =
      std::find_if(sorts.begin(), sorts.end(), [&](const auto& s) { return section.has(s.key); });
  if (sort == sorts.end())
    return section.report(
        "neither file nor position, lattice or fill; add e.g. \"file: packing.txt\", or \"position: [0, 0, "
        "0]\" "
        "and \"radius: 5 mm\"");
  check_sort(section, *sort);
  if (sort->key == "file")
    read_packing(section, kind, draft, balls);
  else if (sort->key == "position")
    read_single(section, kind, balls);
  else if (sort->key == "lattice")
    read_lattice(section, kind, draft, balls);
  else
    read_fill(section, kind, draft, balls);
}

}  // namespace

model::FixedComponents read_fixed(const Section& section, std::string_view key) {
  static constexpr std::array<std::string_view, 6> components{"x", "y", "z", "wx", "wy", "wz"};
  model::FixedComponents fixed;
  for (const std::string& word : section.texts(key).value_or(std::vector<std::string>())) {
    if (word == "all") return model::FixedComponents(63);
    for (int k = 0; k < 6; ++k)
      if (components[k] == word) fixed.fix(k);
  }
  return fixed;
}

double read_own_damping(const Section& section) {
  return section.has("damping") ? section.quantity("damping").value_or(model::Bodies::scene_damping)
                                : model::Bodies::scene_damping;
}

Place BallPlaces::of(std::int32_t ball) const {
  const auto b = static_cast<std::size_t>(ball);
  return {files[static_cast<std::size_t>(file[b])], line[b]};
}

void read_ball_entries(const std::vector<Section>& entries, SceneDraft& draft) {
  for (const Section& section : entries) {
    BallList balls(draft, section.diagnostics());
    read_entry(section, draft, balls);
  }
}

void read_balls(const Section& root, SceneDraft& draft) {
  Diagnostics& diagnostics = root.diagnostics();
  const std::int64_t mistakes_before = diagnostics.count();
  read_ball_entries(root.sections("balls"), draft);
  if (root.has("balls") && draft.scene.bodies.size() == 0 && diagnostics.count() == mistakes_before)
    root.report("balls", "no balls; add e.g. \"- {position: [0, 0, 0], radius: 5 mm, material: grain}\"");
  draft.balls_complete = diagnostics.count() == mistakes_before;
}

}  // namespace eigengrain::io
