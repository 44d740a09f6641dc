#pragma once

#include "eigengrain/model/region.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

/// Which balls something is about: plain data, as the scene says it.
namespace eigengrain::model {

/// The balls for which all holds that is given; nothing given: all balls.
struct Selection {
  std::optional<Region> region{};                    ///< their centres lie in it
  std::optional<std::int32_t> material{};            ///< index into Scene::materials
  std::optional<std::vector<std::int64_t>> balls{};  ///< identities
  std::optional<std::string> group{};                ///< one that was made before
};

/// A group is chosen once, by where the balls are at that moment, and keeps its balls.
struct GroupChoice {
  std::string name{};
  Selection of{};
};

/// The balls of a group, by identity, increasing.
struct Group {
  std::string name{};
  std::vector<std::int64_t> balls{};
};

}  // namespace eigengrain::model
