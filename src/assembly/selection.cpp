#include "eigengrain/assembly/selection.hpp"

#include "eigengrain/base/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace eigengrain::assembly {
namespace {

const model::Group& find_group(std::span<const model::Group> groups, const std::string& name,
                               const std::string& where) {
  const auto found = std::find_if(groups.begin(), groups.end(),
                                  [&](const model::Group& group) { return group.name == name; });
  if (found == groups.end())
    throw InputError(fmt::format("{}: there is no group \"{}\"; make it under groups first", where, name));
  return *found;
}

/// Keeps the rows whose identities are in the list, which is sorted.
void keep_balls(const model::Bodies& bodies, std::span<const std::int64_t> balls,
                std::vector<std::int32_t>& rows) {
  std::erase_if(rows, [&](std::int32_t row) {
    return !std::binary_search(balls.begin(), balls.end(), bodies.identity[static_cast<std::size_t>(row)]);
  });
}

/// Identities of the balls of a state are its rows in some order.
std::vector<std::int64_t> sorted_balls(std::vector<std::int64_t> balls, const model::Bodies& bodies,
                                       const std::string& where) {
  std::sort(balls.begin(), balls.end());
  if (!balls.empty() && (balls.front() < 0 || balls.back() >= bodies.size()))
    throw InputError(fmt::format("{}: there is no ball {}; the {} balls are numbered from 0 to {}", where,
                                 balls.front() < 0 ? balls.front() : balls.back(), bodies.size(),
                                 bodies.size() - 1));
  return balls;
}

}  // namespace

std::vector<std::int32_t> selected(const model::Bodies& bodies, std::span<const model::Group> groups,
                                   const model::Selection& selection, const std::string& where) {
  std::vector<std::int32_t> rows;
  for (std::int32_t row = 0; row < bodies.size(); ++row) {
    const auto i = static_cast<std::size_t>(row);
    if (selection.material && bodies.material[i] != *selection.material) continue;
    if (selection.region && !model::contains(*selection.region, bodies.position[i])) continue;
    rows.push_back(row);
  }
  if (selection.balls) keep_balls(bodies, sorted_balls(*selection.balls, bodies, where), rows);
  if (selection.group) keep_balls(bodies, find_group(groups, *selection.group, where).balls, rows);
  return rows;
}

void make_groups(const model::Bodies& bodies, std::span<const model::GroupChoice> choices,
                 std::vector<model::Group>& groups, const std::string& where) {
  for (const model::GroupChoice& choice : choices) {
    const std::string place = fmt::format("{}, \"{}\"", where, choice.name);
    model::Group group{.name = choice.name, .balls = {}};
    for (const std::int32_t row : selected(bodies, groups, choice.of, place))
      group.balls.push_back(bodies.identity[static_cast<std::size_t>(row)]);
    if (group.balls.empty())
      throw InputError(
          fmt::format("{}: no ball is meant; groups are made where they stand, those of a scene at its "
                      "start: look at where "
                      "the balls are then",
                      place));
    std::sort(group.balls.begin(), group.balls.end());
    std::erase_if(groups, [&](const model::Group& other) { return other.name == group.name; });
    groups.push_back(std::move(group));
  }
}

}  // namespace eigengrain::assembly
