#include "chart.hpp"

#include "labels.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace eigengrain::report {
namespace {

constexpr double label_size = text_size;
constexpr double label_height = 13.5;
constexpr double name_size = 11.5;
constexpr double baseline = 3.5;  // from the middle of a text to where it stands

bool is_drawn(const Point& point) {
  return std::isfinite(point.x) && std::isfinite(point.y);
}

/// The frame of a chart, and how values come into it.
class Panel {
 public:
  Panel(const Chart& chart, const Box& frame) : chart_(chart), frame_(frame) {}

  const Box& frame() const { return frame_; }
  Place place(const Point& point) const {
    return {frame_.left + chart_.x.place(point.x) * frame_.width(),
            frame_.bottom - chart_.y.place(point.y) * frame_.height()};
  }

 private:
  const Chart& chart_;
  Box frame_;
};

void draw_x_axis(const Axis& axis, const std::string& name, const Box& frame, Svg& svg) {
  std::vector<Line> grid;
  std::vector<Line> ticks;
  for (const Tick& tick : axis.ticks()) {
    const double x = frame.left + axis.place(tick.value) * frame.width();
    ticks.push_back({{x, frame.bottom}, {x, frame.bottom + (tick.label.empty() ? 3 : 5)}});
    if (tick.label.empty()) continue;
    grid.push_back({{x, frame.top}, {x, frame.bottom}});
    svg.text({x, frame.bottom + 16}, tick.label, Align::middle);
  }
  svg.lines(grid, colour::faint, 0.6);
  svg.lines(ticks, colour::ink, 0.8);
  svg.text({0.5 * (frame.left + frame.right), frame.bottom + 34}, name, Align::middle, name_size);
}

void draw_y_axis(const Axis& axis, const std::string& name, const Box& frame, Svg& svg) {
  std::vector<Line> grid;
  std::vector<Line> ticks;
  for (const Tick& tick : axis.ticks()) {
    const double y = frame.bottom - axis.place(tick.value) * frame.height();
    ticks.push_back({{frame.left - (tick.label.empty() ? 3 : 5), y}, {frame.left, y}});
    if (tick.label.empty()) continue;
    grid.push_back({{frame.left, y}, {frame.right, y}});
    svg.text({frame.left - 8, y + baseline}, tick.label, Align::end);
  }
  svg.lines(grid, colour::faint, 0.6);
  svg.lines(ticks, colour::ink, 0.8);
  svg.text({14, 0.5 * (frame.top + frame.bottom)}, name, Align::middle, name_size, colour::ink, -90);
}

double widest(const std::vector<std::string>& texts) {
  double width = 0;
  for (const std::string& text : texts) width = std::max(width, text_width(text, label_size));
  return width;
}

/// Names of lines, to the right of the frame, each at the height of its end as near as there is room.
void draw_line_names(const Chart& chart, const Panel& panel, Svg& svg) {
  struct End {
    const Series* series;
    Place place;
  };
  std::vector<End> ends;
  for (const Series& series : chart.series) {
    if (!series.joined) continue;
    const auto last = std::find_if(series.points.rbegin(), series.points.rend(), is_drawn);
    if (last != series.points.rend()) ends.push_back({&series, panel.place(*last)});
  }
  std::vector<double> heights(ends.size());
  std::transform(ends.begin(), ends.end(), heights.begin(), [](const End& end) { return end.place.y; });
  const Box& frame = panel.frame();
  const std::vector<double> placed = spread(heights, label_height, frame.top, frame.bottom);
  std::vector<Line> leaders;
  for (std::size_t k = 0; k < ends.size(); ++k) {
    const Place at{frame.right + 22, placed[k]};
    leaders.push_back({{ends[k].place.x + 6, ends[k].place.y}, {at.x - 4, at.y}});
    svg.text({at.x, at.y + baseline}, ends[k].series->name);
  }
  svg.lines(leaders, colour::grey, 0.5);
}

void draw_mark_names(const Chart& chart, const Panel& panel, Svg& svg) {
  std::vector<LabelWish> wishes;
  std::vector<const Series*> named;
  std::vector<Box> obstacles;
  for (const Series& series : chart.series)
    for (std::size_t k = 0; k < series.points.size(); ++k) {
      if (!is_drawn(series.points[k])) continue;
      const Place place = panel.place(series.points[k]);
      const bool names = !series.joined && !series.name.empty() && k + 1 == series.points.size();
      if (names) {
        wishes.push_back({place, text_width(series.name, label_size), label_height});
        named.push_back(&series);
      } else {
        obstacles.push_back(Box::about(place, 5));
      }
    }
  const auto labels = place_labels(wishes, panel.frame().grown(-2), obstacles);
  std::vector<Line> leaders;
  for (std::size_t k = 0; k < labels.size(); ++k)
    if (labels[k] && labels[k]->leader) leaders.push_back({wishes[k].mark, labels[k]->anchor});
  svg.lines(leaders, colour::grey, 0.5);
  for (std::size_t k = 0; k < labels.size(); ++k)
    if (labels[k]) svg.text({labels[k]->box.left + 1, labels[k]->box.bottom - 3.4}, named[k]->name);
}

}  // namespace

std::string svg_of(const Chart& chart) {
  std::vector<std::string> line_names;
  for (const Series& series : chart.series)
    if (series.joined) line_names.push_back(series.name);
  std::vector<std::string> y_labels;
  for (const Tick& tick : chart.y.ticks()) y_labels.push_back(tick.label);
  const double right = line_names.empty() ? 16 : 30 + widest(line_names);
  const Panel panel(chart, {40 + widest(y_labels), 12, chart.width - right, chart.height - 44});
  const Box& frame = panel.frame();

  Svg svg(chart.width, chart.height, chart.title);
  draw_x_axis(chart.x, chart.x_name, frame, svg);
  draw_y_axis(chart.y, chart.y_name, frame, svg);
  svg.rectangle(frame, "none", colour::ink);
  for (const Guide& guide : chart.guides) {
    std::vector<Place> places;
    for (const Point& point : guide.points) places.push_back(panel.place(point));
    svg.polyline(places, colour::ink, 1, "5 3");
    if (!places.empty())
      svg.text({places.front().x + 6, places.front().y - 6}, guide.name, Align::start, label_size,
               colour::grey);
  }
  for (const Series& series : chart.series) {
    if (!series.joined) continue;
    std::vector<Place> places;
    for (const Point& point : series.points)
      if (is_drawn(point)) places.push_back(panel.place(point));
    svg.polyline(places, series.look.colour, 1);
  }
  draw_line_names(chart, panel, svg);
  draw_mark_names(chart, panel, svg);
  for (const Series& series : chart.series)
    for (const Point& point : series.points)
      if (is_drawn(point)) svg.mark(panel.place(point), series.look, series.joined ? 3 : 4);
  return svg.finish();
}

std::string svg_of_key(const std::vector<KeyEntry>& entries, double width) {
  constexpr double row = 18;
  std::vector<Place> places;
  double x = 10;
  double y = 12;
  for (const KeyEntry& entry : entries) {
    const double room = 34 + text_width(entry.meaning, 11);
    if (x > 10 && x + room > width) {
      x = 10;
      y += row;
    }
    places.push_back({x, y});
    x += room;
  }
  Svg svg(width, y + 10, "Key to the marks");
  for (std::size_t k = 0; k < entries.size(); ++k) {
    svg.mark(places[k], entries[k].look);
    svg.text({places[k].x + 10, places[k].y + 4}, entries[k].meaning);
  }
  return svg.finish();
}

std::string svg_of(const StripChart& chart) {
  constexpr double row = 17;
  std::vector<std::string> names;
  for (const Strip& strip : chart.strips) names.push_back(strip.name);
  const double height = 8 + row * static_cast<double>(chart.strips.size()) + 46;
  const Box frame{18 + widest(names), 8, chart.width - 18, height - 44};
  Svg svg(chart.width, height, chart.title);
  draw_x_axis(chart.x, chart.x_name, frame, svg);
  svg.rectangle(frame, "none", colour::ink);
  const auto along = [&](double x) { return frame.left + chart.x.place(x) * frame.width(); };
  if (chart.guide)
    svg.line({along(*chart.guide), frame.top}, {along(*chart.guide), frame.bottom}, colour::ink, 1, "5 3");
  double y = frame.top + 0.5 * row;
  for (const Strip& strip : chart.strips) {
    svg.line({frame.left, y}, {frame.right, y}, colour::faint, 0.6);
    svg.text({frame.left - 8, y + baseline}, strip.name, Align::end, label_size);
    for (const Strip::Value& value : strip.values)
      if (std::isfinite(value.x)) svg.mark({along(value.x), y}, value.look, 3);
    if (strip.middle)
      svg.line({along(*strip.middle), y - 7}, {along(*strip.middle), y + 7}, colour::ink, 2.4);
    y += row;
  }
  return svg.finish();
}

}  // namespace eigengrain::report
