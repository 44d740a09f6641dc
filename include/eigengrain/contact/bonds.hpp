#pragma once

#include "eigengrain/base/type_list.hpp"
#include "eigengrain/contact/bonds/contact_bond.hpp"
#include "eigengrain/contact/bonds/incremental_parallel_bond.hpp"
#include "eigengrain/contact/bonds/parallel_bond.hpp"

namespace eigengrain::contact {

/// The table of the bonds that exist, between balls only. As with laws (laws.hpp), of several types with one
/// name the first whose serves(parameters) holds is taken.
using BondTypes = TypeList<ParallelBond, IncrementalParallelBond, ContactBond, DampedContactBond>;

}  // namespace eigengrain::contact
