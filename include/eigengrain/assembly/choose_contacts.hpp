#pragma once

#include "eigengrain/assembly/state.hpp"
#include "eigengrain/model/stage.hpp"

#include <cstdint>
#include <string>

namespace eigengrain::assembly {

/// Gives contacts that act now the law of another entry: those of which both balls are selected, or, at a
/// wall, the ball. They keep as much of their history as that law knows, and go back to the entry of their
/// materials once they have opened (at the first near list after that). Bonds, and contacts with
/// surfaces of triangles, are left alone. The next step
/// is chosen anew, and a ledger begins anew. Returns their number; throws InputError, beginning with `where`,
/// where the entry or the wall does not exist and where no contact is meant.
std::int64_t choose_contacts(State& state, const model::ContactChoice& choice, const std::string& where);

}  // namespace eigengrain::assembly
