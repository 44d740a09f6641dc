#include "mesh_reader.hpp"

#include "quantity.hpp"
#include "text_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstring>
#include <map>
#include <optional>
#include <vector>

namespace eigengrain::io {
namespace {

using model::SurfaceProblem;
using model::Triangle;

/// Builds a surface triangle by triangle and merges corners at one place.
class SurfaceBuilder {
 public:
  SurfaceBuilder(std::string name, Diagnostics& diagnostics)
      : name_(std::move(name)), diagnostics_(diagnostics) {}

  void add(const std::array<Vec3, 3>& corners) {
    Triangle triangle;
    for (std::size_t k = 0; k < 3; ++k) triangle[k] = vertex(corners[k]);
    surface_.triangles.push_back(triangle);
  }
  void report(int line, std::string message, std::string_view kind) {
    diagnostics_.add({name_, line}, std::move(message), kind);
  }
  model::Surface take() { return std::move(surface_); }

 private:
  std::int32_t vertex(const Vec3& x) {
    // Adding zero makes -0 the same place as 0.
    const std::array<double, 3> key{x[0] + 0.0, x[1] + 0.0, x[2] + 0.0};
    const auto [entry, added] = index_.try_emplace(key, static_cast<std::int32_t>(surface_.vertices.size()));
    if (added) surface_.vertices.emplace_back(key[0], key[1], key[2]);
    return entry->second;
  }

  std::string name_;
  Diagnostics& diagnostics_;
  model::Surface surface_;
  std::map<std::array<double, 3>, std::int32_t> index_;
};

/// A line's words, between blanks.
std::vector<std::string_view> words_of(std::string_view line) {
  constexpr std::string_view blanks = " \t\r\v\f";
  std::vector<std::string_view> words;
  for (std::size_t begin = line.find_first_not_of(blanks); begin != std::string_view::npos;) {
    const std::size_t end = std::min(line.find_first_of(blanks, begin), line.size());
    words.push_back(line.substr(begin, end - begin));
    begin = line.find_first_not_of(blanks, end);
  }
  return words;
}

/// Calls visit(words, line number) for every line that is not empty.
template <class Visit>
void for_each_line(std::string_view text, const Visit& visit) {
  for (int number = 1; !text.empty(); ++number) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const auto words = words_of(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
    if (!words.empty()) visit(words, number);
  }
}

/// Three coordinates behind the first word, or a report.
std::optional<Vec3> read_corner(const std::vector<std::string_view>& words, int line,
                                SurfaceBuilder& surface) {
  if (words.size() < 4) {
    surface.report(line, fmt::format("{} coordinates; three are wanted", words.size() - 1), "coordinates");
    return std::nullopt;
  }
  Vec3 x;
  for (int k = 0; k < 3; ++k) {
    const std::string_view word = words[static_cast<std::size_t>(k) + 1];
    const auto [number, problem] = read_leading_number(word, "a coordinate is a plain number");
    if (!number || !number->rest.empty()) {
      surface.report(line, fmt::format("\"{}\" {}", word, number ? "is not a number" : problem), "number");
      return std::nullopt;
    }
    x[k] = number->value;
  }
  return x;
}

void read_ascii_stl(std::string_view text, SurfaceBuilder& surface) {
  std::vector<Vec3> corners;
  bool whole = true;
  for_each_line(text, [&](const std::vector<std::string_view>& words, int line) {
    if (words[0] == "vertex") {
      const auto x = read_corner(words, line, surface);
      if (x) corners.push_back(*x);
      whole = whole && x.has_value();
    } else if (words[0] == "endfacet") {
      if (whole && corners.size() != 3)
        surface.report(line, fmt::format("a facet with {} corners; three are wanted", corners.size()),
                       "corners");
      else if (whole)
        surface.add({corners[0], corners[1], corners[2]});
      corners.clear();
      whole = true;
    }
  });
}

constexpr std::size_t stl_header = 84;
constexpr std::size_t stl_triangle = 50;

std::uint32_t stl_count(std::string_view bytes) {
  std::uint32_t count = 0;
  std::memcpy(&count, &bytes[stl_header - sizeof(count)], sizeof(count));
  return count;
}

/// Many writers begin binary files with "solid" as well, so that only the size tells.
bool is_binary_stl(std::string_view bytes) {
  return bytes.size() >= stl_header && bytes.size() == stl_header + stl_triangle * stl_count(bytes);
}

void read_binary_stl(std::string_view bytes, SurfaceBuilder& surface) {
  for (std::uint32_t t = 0; t < stl_count(bytes); ++t) {
    std::array<float, 9> numbers{};
    constexpr std::size_t normal = 3 * sizeof(float);
    std::memcpy(numbers.data(), &bytes[stl_header + stl_triangle * t + normal], sizeof(numbers));
    if (!std::all_of(numbers.begin(), numbers.end(), [](float x) { return std::isfinite(x); })) {
      surface.report(0, fmt::format("triangle {}: a coordinate is not a finite number", t + 1), "number");
      continue;
    }
    std::array<Vec3, 3> corners;
    for (std::size_t k = 0; k < 3; ++k)
      corners[k] = {double{numbers[3 * k]}, double{numbers[3 * k + 1]}, double{numbers[3 * k + 2]}};
    surface.add(corners);
  }
}

/// Index into the vertices so far of "7", "7/1/3" or "-1"; -1 if there is none.
std::ptrdiff_t obj_index(std::string_view word, std::size_t vertices) {
  const std::string_view digits = word.substr(0, word.find('/'));
  std::int64_t index = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), index);
  if (error != std::errc() || end != digits.data() + digits.size()) return -1;
  const auto count = static_cast<std::int64_t>(vertices);
  if (index < 0) index += count + 1;
  return index >= 1 && index <= count ? static_cast<std::ptrdiff_t>(index - 1) : -1;
}

void read_obj(std::string_view text, SurfaceBuilder& surface) {
  std::vector<Vec3> vertices;
  for_each_line(text, [&](const std::vector<std::string_view>& words, int line) {
    if (words[0] == "v") {
      // A vertex that cannot be read keeps its number.
      vertices.push_back(read_corner(words, line, surface).value_or(Vec3::Zero()));
    } else if (words[0] == "f") {
      std::vector<Vec3> corners;
      for (std::size_t k = 1; k < words.size(); ++k) {
        const std::ptrdiff_t index = obj_index(words[k], vertices.size());
        if (index < 0)
          return surface.report(
              line, fmt::format("\"{}\" names none of the {} vertices so far", words[k], vertices.size()),
              "vertex");
        corners.push_back(vertices[static_cast<std::size_t>(index)]);
      }
      if (corners.size() < 3)
        return surface.report(line, fmt::format("a face with {} corners; three are wanted", corners.size()),
                              "corners");
      for (std::size_t k = 2; k < corners.size(); ++k) surface.add({corners[0], corners[k - 1], corners[k]});
    }
  });
}

void report_problems(const model::Surface& surface, const std::string& name, Diagnostics& diagnostics) {
  using Kind = SurfaceProblem::Kind;
  for (const SurfaceProblem& p : model::problems_of(surface)) {
    const auto add = [&](std::string message, const char* kind) {
      diagnostics.add({name, 0}, std::move(message), kind);
    };
    switch (p.kind) {
      case Kind::degenerate:
        add(fmt::format(
                "triangle {} at {} has no area; remove it, or merge its corners in the program that made the "
                "mesh",
                p.first + 1, text_of(p.place)),
            "degenerate");
        break;
      case Kind::branching:
        add(fmt::format(
                "more than two triangles (the first are {} and {}) share the edge at {}; give every edge one "
                "or two",
                p.first + 1, p.second + 1, text_of(p.place)),
            "branching");
        break;
      case Kind::inconsistent:
        add(fmt::format(
                "triangles {} and {} share the edge at {} and face opposite ways, so the active side is not "
                "clear; turn one around, or write \"two_sided: true\"",
                p.first + 1, p.second + 1, text_of(p.place)),
            "inconsistent");
        break;
    }
  }
}

}  // namespace

model::Surface parse_mesh(std::string_view contents, const std::string& name, double unit, bool two_sided,
                          const Place& asked_at, Diagnostics& diagnostics) {
  const std::int64_t mistakes_before = diagnostics.count();
  SurfaceBuilder builder(name, diagnostics);
  if (has_ending(name, ".obj")) {
    read_obj(contents, builder);
  } else if (!has_ending(name, ".stl")) {
    diagnostics.add(asked_at,
                    fmt::format("\"{}\" ends in neither .stl nor .obj, the meshes that can be read", name));
  } else if (is_binary_stl(contents)) {
    read_binary_stl(contents, builder);
  } else if (contents.starts_with("solid")) {
    read_ascii_stl(contents, builder);
  } else {
    diagnostics.add({name, 0},
                    contents.size() < stl_header
                        ? std::string("no STL file: neither text that begins with \"solid\", nor binary")
                        : fmt::format("cut short or no STL file: {} bytes, and a binary one of {} triangles "
                                      "has {}",
                                      contents.size(), stl_count(contents),
                                      stl_header + stl_triangle * std::size_t{stl_count(contents)}));
  }
  model::Surface surface = builder.take();
  if (diagnostics.count() != mistakes_before) return {};
  if (surface.triangles.empty()) {
    diagnostics.add(asked_at, fmt::format("\"{}\" holds no triangles", name));
    return {};
  }
  for (Vec3& x : surface.vertices) x *= unit;
  surface.two_sided = two_sided;
  if (two_sided && !model::orient(surface)) {
    diagnostics.add({name, 0},
                    "the surface has one side only, as a Möbius strip has, so that the side a ball is on has "
                    "no meaning; cut it open along an edge");
    return {};
  }
  report_problems(surface, name, diagnostics);
  return diagnostics.count() == mistakes_before ? surface : model::Surface{};
}

model::Surface read_mesh(const std::filesystem::path& file, double unit, bool two_sided,
                         const Place& asked_at, Diagnostics& diagnostics) {
  const auto [contents, problem] = read_text_file(file);
  if (!contents) {
    diagnostics.add(asked_at, problem);
    return {};
  }
  return parse_mesh(*contents, file.string(), unit, two_sided, asked_at, diagnostics);
}

}  // namespace eigengrain::io
