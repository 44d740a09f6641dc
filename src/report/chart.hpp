#pragma once

#include "axis.hpp"
#include "svg.hpp"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

/// Pictures of numbers against numbers.
namespace eigengrain::report {

struct Point {
  double x = 0;
  double y = 0;
};

/// Marks of one look, joined by a line or not. The name stands beside the last mark, or, of a series that is
/// joined, beside the end of its line.
struct Series {
  std::string name;
  Look look{};
  std::vector<Point> points{};
  bool joined = false;
};

/// A line that nobody measured: a law, a limit.
struct Guide {
  std::string name;
  std::vector<Point> points;
};

struct Chart {
  std::string title;  ///< for those who cannot see it
  Axis x;
  Axis y;
  std::string x_name;
  std::string y_name;
  std::vector<Series> series{};
  std::vector<Guide> guides{};
  double width = 720;
  double height = 440;
};

/// Points that are not finite are left out. Names of single marks go wherever there is room, those of lines
/// to the right of the frame, and none covers another.
std::string svg_of(const Chart& chart);

/// What a look stands for.
struct KeyEntry {
  Look look;
  std::string meaning;
};
std::string svg_of_key(const std::vector<KeyEntry>& entries, double width = 720);

/// Rows of marks along one axis: many values of each of many things.
struct Strip {
  struct Value {
    double x = 0;
    Look look{};
  };
  std::string name;
  std::vector<Value> values;
  std::optional<double> middle{};  ///< a short line, for a median
};
struct StripChart {
  std::string title;
  Axis x;
  std::string x_name;
  std::optional<double> guide{};  ///< a value to compare with
  std::vector<Strip> strips{};
  double width = 720;
};
std::string svg_of(const StripChart& chart);

}  // namespace eigengrain::report
