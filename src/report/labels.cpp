#include "labels.hpp"

#include <algorithm>
#include <cstddef>
#include <numbers>
#include <numeric>

namespace eigengrain::report {
namespace {

constexpr double mark_half = 6;   // the room of a mark
constexpr double near_mark = 14;  // a label nearer than this needs no line
constexpr double step = 5;        // between rings of candidates
constexpr int directions = 24;
constexpr double lines_clear = 160;  // how far a label goes for a line that crosses nothing

/// The box of a label in a direction from its mark, its nearest side or corner at a distance.
Box candidate(const LabelWish& wish, double angle, double distance) {
  const double x = wish.mark.x + distance * std::cos(angle);
  const double y = wish.mark.y + distance * std::sin(angle);
  // To the right of the point where it looks right, centred where it looks up, and so on between.
  const double left = x - 0.5 * wish.width * (1 - std::cos(angle));
  const double top = y - 0.5 * wish.height * (1 - std::sin(angle));
  return {left, top, left + wish.width, top + wish.height};
}

Place nearest(const Box& box, const Place& to) {
  return {std::clamp(to.x, box.left, box.right), std::clamp(to.y, box.top, box.bottom)};
}

class Board {
 public:
  Board(std::span<const LabelWish> wishes, const Box& frame, std::span<const Box> obstacles)
      : frame_(frame), obstacles_(obstacles.begin(), obstacles.end()) {
    for (const LabelWish& wish : wishes) marks_.push_back(Box::about(wish.mark, mark_half));
  }

  std::optional<PlacedLabel> place(const LabelWish& wish) {
    const double farthest = frame_.width() + frame_.height();
    for (const bool clear_lines : {true, false})
      for (double distance = mark_half + 2; distance < (clear_lines ? lines_clear : farthest);
           distance += step)
        for (int k = 0; k < directions; ++k) {
          // Right, left, then turning away from them, above before below.
          const int turn = (k / 2 + 1) / 2 * (k / 2 % 2 == 0 ? 1 : -1);
          const double angle = (k % 2 == 0 ? 0 : std::numbers::pi) + turn * 2 * std::numbers::pi / directions;
          const Box box = candidate(wish, angle, distance);
          if (!is_free(box)) continue;
          const PlacedLabel label{box, nearest(box, wish.mark), distance > near_mark};
          if (clear_lines && !line_is_clear(wish, label)) continue;
          labels_.push_back(box);
          if (label.leader) lines_.push_back({wish.mark, label.anchor});
          return label;
        }
    return std::nullopt;
  }

 private:
  bool is_free(const Box& box) const {
    const auto hits = [&](const Box& other) { return box.overlaps(other); };
    return frame_.holds(box) && std::none_of(labels_.begin(), labels_.end(), hits) &&
           std::none_of(marks_.begin(), marks_.end(), hits) &&
           std::none_of(obstacles_.begin(), obstacles_.end(), hits);
  }
  bool line_is_clear(const LabelWish& wish, const PlacedLabel& label) const {
    const auto under_line = [&](const Line& line) { return crosses(label.box, line.from, line.to); };
    if (std::any_of(lines_.begin(), lines_.end(), under_line)) return false;
    if (!label.leader) return true;
    const auto crossed = [&](const Box& other) { return crosses(other, wish.mark, label.anchor); };
    const auto crossed_mark = [&](const Box& mark) {
      return !mark.overlaps(Box::about(wish.mark, 1)) && crossed(mark);
    };
    return std::none_of(labels_.begin(), labels_.end(), crossed) &&
           std::none_of(marks_.begin(), marks_.end(), crossed_mark);
  }

  Box frame_;
  std::vector<Box> obstacles_;
  std::vector<Box> marks_;
  std::vector<Box> labels_;
  std::vector<Line> lines_;
};

/// Marks so near that their labels get in each other's way.
int crowd(std::span<const LabelWish> wishes, const LabelWish& of) {
  return static_cast<int>(std::count_if(wishes.begin(), wishes.end(), [&](const LabelWish& other) {
    return std::abs(other.mark.x - of.mark.x) < of.width &&
           std::abs(other.mark.y - of.mark.y) < 3 * of.height;
  }));
}

}  // namespace

bool crosses(const Box& box, const Place& a, const Place& b) {
  double enter = 0;
  double leave = 1;
  const auto clip = [&](double from, double along, double low, double high) {
    if (along == 0) return low < from && from < high;
    const double first = (low - from) / along;
    const double second = (high - from) / along;
    enter = std::max(enter, std::min(first, second));
    leave = std::min(leave, std::max(first, second));
    return enter < leave;
  };
  return clip(a.x, b.x - a.x, box.left, box.right) && clip(a.y, b.y - a.y, box.top, box.bottom);
}

std::vector<std::optional<PlacedLabel>> place_labels(std::span<const LabelWish> wishes, const Box& frame,
                                                     std::span<const Box> obstacles) {
  std::vector<std::size_t> order(wishes.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t i, std::size_t j) {
    return crowd(wishes, wishes[i]) > crowd(wishes, wishes[j]);
  });
  Board board(wishes, frame, obstacles);
  std::vector<std::optional<PlacedLabel>> result(wishes.size());
  for (const std::size_t i : order) result[i] = board.place(wishes[i]);
  return result;
}

std::vector<double> spread(std::span<const double> wished, double gap, double low, double high) {
  const std::size_t n = wished.size();
  std::vector<std::size_t> order(n);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t i, std::size_t j) { return wished[i] < wished[j]; });
  if (n > 1) gap = std::min(gap, (high - low) / static_cast<double>(n - 1));
  // Groups of neighbours that touch: each stands with its mean where the mean of its wishes is (the
  // least-squares answer, by pooling adjacent violators).
  struct Group {
    std::size_t begin = 0;
    std::size_t count = 0;
    double sum = 0;  // of the wishes, less their places in the group
    double start(double space, double low_end, double high_end) const {
      const double length = space * static_cast<double>(count - 1);
      return std::clamp(sum / static_cast<double>(count), low_end, std::max(low_end, high_end - length));
    }
  };
  std::vector<Group> groups;
  for (std::size_t k = 0; k < n; ++k) {
    groups.push_back({k, 1, wished[order[k]]});
    while (groups.size() > 1) {
      const Group& last = groups[groups.size() - 1];
      Group& before = groups[groups.size() - 2];
      const double end = before.start(gap, low, high) + gap * static_cast<double>(before.count);
      if (last.start(gap, low, high) >= end) break;
      before.sum += last.sum - gap * static_cast<double>(before.count) * static_cast<double>(last.count);
      before.count += last.count;
      groups.pop_back();
    }
  }
  std::vector<double> result(n);
  for (const Group& group : groups)
    for (std::size_t k = 0; k < group.count; ++k)
      result[order[group.begin + k]] = group.start(gap, low, high) + gap * static_cast<double>(k);
  return result;
}

}  // namespace eigengrain::report
