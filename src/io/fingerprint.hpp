#pragma once

#include "eigengrain/model/surface.hpp"

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

namespace eigengrain::io {

/// A number that changes with columns of numbers, as the vertices and triangles of a surface (FNV-1a over
/// their bytes), by which a state knows whether the file of a mesh is still the one that its contacts name.
template <class... Columns>
std::int64_t fingerprint_of(const Columns&... columns) {
  std::uint64_t hash = 14695981039346656037U;
  const auto add = [&](std::span<const std::byte> bytes) {
    for (const std::byte b : bytes) hash = (hash ^ static_cast<std::uint64_t>(b)) * 1099511628211U;
  };
  (add(std::as_bytes(std::span(columns))), ...);
  std::int64_t result = 0;
  std::memcpy(&result, &hash, sizeof(result));
  return result;
}

inline std::int64_t fingerprint(const model::Surface& surface) {
  return fingerprint_of(surface.vertices, surface.triangles);
}
inline std::int64_t fingerprint(const model::Mesh& mesh) {
  return fingerprint_of(mesh.nodes, mesh.elements);
}

inline std::vector<std::int64_t> fingerprints(std::span<const model::Surface> surfaces) {
  std::vector<std::int64_t> result;
  for (const model::Surface& surface : surfaces) result.push_back(fingerprint(surface));
  return result;
}

}  // namespace eigengrain::io
