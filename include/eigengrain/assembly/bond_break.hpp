#pragma once

#include "eigengrain/base/vec.hpp"
#include "eigengrain/contact/bonds/bond.hpp"

#include <cstdint>

namespace eigengrain::assembly {

/// A bond that broke: what users read as a crack.
struct BondBreak {
  std::int64_t step = 0;
  double time = 0;         ///< s
  std::int64_t first = 0;  ///< identities of the balls, in the order of the contact
  std::int64_t second = 0;
  Vec3 place = Vec3::Zero();   ///< the contact point, m
  Vec3 normal = Vec3::Zero();  ///< n, from the first to the second
  contact::BreakMode mode = contact::BreakMode::tension;
  std::int32_t rule = 0;   ///< index into Scene::contacts
  std::int32_t entry = 0;  ///< of the scene file's `contacts`
};

}  // namespace eigengrain::assembly
