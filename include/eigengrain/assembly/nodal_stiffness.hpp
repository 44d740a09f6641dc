#pragma once

#include "eigengrain/assembly/model.hpp"
#include "eigengrain/assembly/stiffness.hpp"
#include "eigengrain/assembly/stiffness_parts.hpp"
#include "eigengrain/assembly/unknowns.hpp"

#include <cstdint>
#include <functional>
#include <vector>

namespace eigengrain::assembly {

struct Trial;

/// Bodies that only such elements touch, or turn.
std::vector<TouchedBody> touched_by_nodal(const Model& model, Listed which);
NodalStiffness nodal_stiffness(const Model& model, Listed which, const Unknowns& unknowns);

/// Hands every block of the consistent tangent of elements and of contacts with skins to add(row block,
/// column block, 3×3 block), masked rows and columns zero, in a trial state: minus the derivative of
/// ContactForceSum::evaluate but for what changes with the point of a skin that is touched, which is smaller
/// by overlap over edge.
void for_each_nodal_tangent(const Model& model, const Trial& trial, const Unknowns& unknowns,
                            const std::function<void(std::int32_t, std::int32_t, const Mat3&)>& add);

}  // namespace eigengrain::assembly
