#pragma once

#include "eigengrain/base/type_list.hpp"
#include "eigengrain/contact/laws/hertz.hpp"
#include "eigengrain/contact/laws/hysteretic.hpp"
#include "eigengrain/contact/laws/linear.hpp"
#include "eigengrain/contact/laws/linear_frictionless.hpp"

namespace eigengrain::contact {

/// The table of the laws that exist. To add one (docs/add-a-law.md): write laws/<name>.hpp after the contract
/// of law.hpp, add its type here, and add a line to tests/laws/law_contract_test.cpp. Scene files and their
/// documentation pick it up from its description.
///
/// Of several types with one name, the first whose serves(parameters) holds is taken: that is how a scene
/// without friction gets contacts without history, and one without dashpots contacts that know none.
using LawTypes =
    TypeList<LinearFrictionless, Linear, DampedLinear, RollingLinear, Hertz, RollingHertz, Hysteretic>;

}  // namespace eigengrain::contact
