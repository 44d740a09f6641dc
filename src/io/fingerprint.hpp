#pragma once

#include "eigengrain/model/surface.hpp"

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

namespace eigengrain::io {

/// A number that changes with the vertices and triangles of a surface (FNV-1a over their bytes), by which a
/// state knows whether the file of a mesh is still the one that its contacts name.
inline std::int64_t fingerprint(const model::Surface& surface) {
  std::uint64_t hash = 14695981039346656037U;
  const auto add = [&](std::span<const std::byte> bytes) {
    for (const std::byte b : bytes) hash = (hash ^ static_cast<std::uint64_t>(b)) * 1099511628211U;
  };
  add(std::as_bytes(std::span(surface.vertices)));
  add(std::as_bytes(std::span(surface.triangles)));
  std::int64_t result = 0;
  std::memcpy(&result, &hash, sizeof(result));
  return result;
}

inline std::vector<std::int64_t> fingerprints(std::span<const model::Surface> surfaces) {
  std::vector<std::int64_t> result;
  for (const model::Surface& surface : surfaces) result.push_back(fingerprint(surface));
  return result;
}

}  // namespace eigengrain::io
