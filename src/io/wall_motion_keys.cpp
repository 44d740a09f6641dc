#include "wall_motion_keys.hpp"

#include "quantity.hpp"
#include "text_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <string_view>

namespace eigengrain::io {
namespace {

/// Adds rows to a table of velocities and reports times that do not increase.
class RowList {
 public:
  explicit RowList(WallMotionKeys& keys) : keys_(keys) {}

  /// What is wrong with the row's time; empty if the row was added.
  std::string add(double time, const model::WallVelocity& velocity) {
    if (keys_.moves() && time <= keys_.time.back())
      return fmt::format("time {:g} s is not above the {:g} s of the row before; sort the rows by time", time,
                         keys_.time.back());
    keys_.time.push_back(time);
    keys_.velocity.push_back(velocity);
    return {};
  }

 private:
  WallMotionKeys& keys_;
};

void read_rows(const Section& wall, WallMotionKeys& keys) {
  RowList rows(keys);
  const auto sections = wall.sections("motion");
  if (sections.empty())
    wall.report("motion", "no rows; write e.g. \"motion: [{time: 0, velocity: [0, 0, -0.5]}]\"");
  for (const Section& row : sections) {
    row.check_keys();
    const auto time = row.quantity("time");
    const auto velocity = row.vector("velocity");
    const auto spin = row.vector("spin");
    if (!time || !velocity || !spin) continue;
    const std::string problem = rows.add(*time, {*velocity, *spin});
    if (!problem.empty()) row.report("time", problem);
  }
}

/// The numbers of a line, between commas or blanks; a problem with one that is none.
Parsed<std::vector<double>> numbers_of(std::string_view line) {
  constexpr std::string_view separators = ", \t\r;";
  constexpr std::string_view hint = "columns are plain numbers in SI units, and other lines begin with #";
  std::vector<double> numbers;
  while (true) {
    const std::size_t begin = line.find_first_not_of(separators);
    if (begin == std::string_view::npos) return {.value = std::move(numbers)};
    const std::size_t end = std::min(line.find_first_of(separators, begin), line.size());
    const std::string_view word = line.substr(begin, end - begin);
    const auto [number, problem] = read_leading_number(word, hint);
    if (!number) return {.problem = fmt::format("\"{}\" {}", word, problem)};
    if (!number->rest.empty()) return {.problem = fmt::format("\"{}\" is not a number; {}", word, hint)};
    numbers.push_back(number->value);
    line.remove_prefix(end);
  }
}

void read_file(const Section& wall, const std::filesystem::path& folder, WallMotionKeys& keys) {
  const auto name = wall.text("motion_file");
  if (!name) return;
  const std::string file = (folder / *name).lexically_normal().string();
  const auto [content, problem] = read_text_file(file);
  if (!content) return wall.report("motion_file", problem);
  Diagnostics& diagnostics = wall.diagnostics();
  RowList rows(keys);
  std::string_view text = *content;
  for (int number = 1; !text.empty(); ++number) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = text.substr(0, std::min(end, text.find('#')));
    text.remove_prefix(std::min(end + 1, text.size()));
    const auto [values, not_a_number] = numbers_of(line);
    if (!values) {
      diagnostics.add({file, number}, not_a_number, "number");
      continue;
    }
    const std::vector<double>& v = *values;
    if (v.empty()) continue;
    if (v.size() != 4 && v.size() != 7) {
      diagnostics.add({file, number},
                      fmt::format("{} columns; four or seven are wanted: time, vx, vy, vz, and wx, wy, wz "
                                  "where the wall turns",
                                  v.size()),
                      "columns");
      continue;
    }
    const model::WallVelocity velocity{{v[1], v[2], v[3]},
                                       v.size() == 7 ? Vec3(v[4], v[5], v[6]) : Vec3(Vec3::Zero())};
    const std::string late = rows.add(v[0], velocity);
    if (!late.empty()) diagnostics.add({file, number}, late, "time");
  }
  if (!keys.moves())
    wall.report("motion_file", fmt::format("\"{}\" holds no rows; a line is time, vx, vy, vz", file));
}

std::optional<ServoKeys> read_servo(const Section& wall) {
  const auto section = wall.section("servo");
  if (!section) return std::nullopt;
  section->check_keys();
  ServoKeys keys;
  if (section->has("direction")) {
    const auto direction = section->vector("direction");
    if (direction && direction->stableNorm() == 0)
      section->report("direction", "zero, which is no direction; write e.g. \"direction: [0, 0, -1]\"");
    else if (direction)
      keys.direction = direction->stableNormalized();
  }
  if (section->has("force") == section->has("stress"))
    section->report("either a force or a stress is wanted, e.g. \"force: 10 N\"");
  if (section->has("area") && !section->has("stress"))
    section->report("area", "has a meaning beside stress only; remove it");
  keys.force = section->quantity("force");
  keys.stress = section->quantity("stress");
  keys.area = section->quantity("area");
  keys.relaxation = section->quantity("relaxation").value_or(0);
  keys.max_speed = section->quantity("max_speed").value_or(0);
  return keys;
}

}  // namespace

std::optional<model::WallMotion> wall_motion(const Section& wall, const WallMotionKeys& keys,
                                             std::int32_t index, const Vec3& centre, const Vec3& normal,
                                             double area) {
  if (!keys.moves()) return std::nullopt;
  model::WallMotion motion{index, centre, keys.time, keys.velocity, {}};
  if (!keys.servo) return motion;
  const ServoKeys& asked = *keys.servo;
  model::Servo& servo = motion.servo.emplace();
  servo.direction = asked.direction.value_or(normal);
  servo.force = asked.force ? *asked.force : asked.stress.value_or(0) * asked.area.value_or(area);
  servo.relaxation = asked.relaxation;
  servo.max_speed = asked.max_speed;
  if (servo.direction.isZero(0))
    wall.report("servo", "a mesh has no direction of its own; add e.g. \"direction: [0, 0, -1]\"");
  if (asked.stress && servo.force == 0)
    wall.report("servo", "a stress on a wall without an area of its own; add e.g. \"area: 0.04 m2\"");
  return motion;
}

WallMotionKeys read_wall_motion(const Section& wall, const std::filesystem::path& folder) {
  WallMotionKeys keys;
  if (wall.has("centre")) keys.centre = wall.vector("centre");
  const bool constant = wall.has("velocity") || wall.has("spin");
  if (constant + wall.has("motion") + wall.has("motion_file") > 1) {
    wall.report("velocity and spin, motion, motion_file: one of the three says how a wall moves; keep one");
    return keys;
  }
  if (constant) {
    const auto velocity = wall.vector("velocity");
    const auto spin = wall.vector("spin");
    if (velocity && spin) RowList(keys).add(0, {*velocity, *spin});
  }
  if (wall.has("motion")) read_rows(wall, keys);
  if (wall.has("motion_file")) read_file(wall, folder, keys);
  keys.servo = read_servo(wall);
  if (keys.servo && !keys.moves()) RowList(keys).add(0, {});
  return keys;
}

}  // namespace eigengrain::io
