#include "report/chart.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <string>

namespace eigengrain::report {
namespace {

using testing::HasSubstr;
using testing::Not;

int count(const std::string& text, const std::string& part) {
  int found = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++found;
  return found;
}

Chart chart() {
  return {.title = "t",
          .x = Axis::logarithmic(1, 100),
          .y = Axis::logarithmic(1, 100),
          .x_name = "x",
          .y_name = "y"};
}

TEST(Chart, DrawsEachMarkAndName) {
  Chart c = chart();
  c.series.push_back({.name = "one & only", .points = {{2, 3}}});
  c.series.push_back({.name = "line", .points = {{1, 1}, {10, 10}, {100, 100}}, .joined = true});
  const std::string svg = svg_of(c);
  EXPECT_EQ(count(svg, "<circle"), 4);
  EXPECT_THAT(svg, HasSubstr(">one &amp; only</text>"));
  EXPECT_THAT(svg, HasSubstr(">line</text>"));
}

TEST(Chart, LeavesOutWhatIsNoNumber) {
  Chart c = chart();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  c.series.push_back({.name = "gone", .points = {{nan, 3}}});
  c.series.push_back({.name = "part", .points = {{1, 1}, {10, nan}, {100, 100}}, .joined = true});
  const std::string svg = svg_of(c);
  EXPECT_EQ(count(svg, "<circle"), 2);
  EXPECT_THAT(svg, Not(HasSubstr("nan")));
}

TEST(Chart, MarksDifferInShapeAndNotInColourAlone) {
  std::vector<std::string> shapes;
  for (const Mark mark : {Mark::circle, Mark::diamond, Mark::square, Mark::triangle, Mark::cross}) {
    Svg one(10, 10, "mark");
    one.mark({5, 5}, {mark, colour::ink, true});
    shapes.push_back(one.finish());
  }
  for (std::size_t i = 0; i < shapes.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) EXPECT_NE(shapes[i], shapes[j]);
}

TEST(StripChart, HasARowForEachName) {
  const StripChart c{.title = "t",
                     .x = Axis::logarithmic(0.1, 10),
                     .x_name = "x",
                     .guide = 1.0,
                     .strips = {{.name = "a", .values = {{1, {}}, {2, {}}}, .middle = 1.5},
                                {.name = "b<", .values = {{3, {}}}}}};
  const std::string svg = svg_of(c);
  EXPECT_EQ(count(svg, "<circle"), 3);
  EXPECT_THAT(svg, HasSubstr(">a</text>"));
  EXPECT_THAT(svg, HasSubstr(">b&lt;</text>"));
}

TEST(Key, SaysWhatEachMarkMeans) {
  const std::string svg =
      svg_of_key({{{Mark::circle, colour::blue, true}, "proven"}, {{Mark::triangle}, "unsafe"}});
  EXPECT_THAT(svg, HasSubstr("proven"));
  EXPECT_THAT(svg, HasSubstr("unsafe"));
}

}  // namespace
}  // namespace eigengrain::report
