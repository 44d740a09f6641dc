#pragma once

#include "eigengrain/assembly/state.hpp"
#include "eigengrain/model/stage.hpp"

#include <string>

namespace eigengrain::assembly {

/// Changes bodies; a velocity that is given is that of the moment, so the leapfrog's, half a step earlier,
/// differs by half a step of the present force. The next step is chosen anew, and a ledger begins anew: the
/// energy is another one. Throws InputError, beginning with `where`, where a selection means nothing, and
/// where the radius of a clump is to change.
void change_bodies(State& state, const model::BodyChange& change, const std::string& where);

}  // namespace eigengrain::assembly
