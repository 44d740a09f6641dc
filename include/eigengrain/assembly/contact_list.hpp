#pragma once

#include "eigengrain/assembly/model.hpp"
#include "eigengrain/assembly/state.hpp"

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

/// Which contacts a model has, from where its bodies are.
namespace eigengrain::assembly {

/// An empty group for a rule: of the kinematics of that name and the first type of the law table that bears
/// the rule's law and serves its parameters. `index` is the rule's place in Scene::contacts. Throws
/// InputError for a law, a kinematics or a number of parameters that do not exist.
contact::AnyGroup new_group(std::string_view kinematics, const model::ContactRule& rule, std::int32_t index);

/// The values of all parameters of a rule's law: those of the rule, and defaults for those left out at the
/// end. Throws InputError where that does not make their number.
std::vector<double> law_values(const model::ContactRule& rule, std::int32_t index,
                               std::span<const contact::ParameterDescription> parameters);

/// Whether any contact that the rules of a scene allow can turn a body. Contacts may form later, so the rules
/// decide and not the contacts.
bool needs_rotation(const model::Scene& scene);

/// What a pair is that is listed for the first time and touches.
enum class NewContacts {
  formed,   ///< as at the start of a scene
  unformed  ///< the next forces form it: so it forms in the same way whether it was listed before or not
};

/// Replaces the contacts of the model by all pairs whose surfaces are no more than `reach` apart (m); with
/// reach 0 by the pairs that touch. A contact that was there keeps its history, and one that still acts stays
/// even beyond the reach. In a periodic cell, centres are wrapped into the cell first; where that has been
/// sheared far, its edges are replaced by shorter ones of the same lattice before (model::reduce).
///
/// In each group contacts are sorted by a, then b, then image. Throws InputError where two centres coincide
/// or no rule of the scene exists for a pair.
void list_contacts(Model& model, const model::Scene& scene, double reach, NewContacts touching);

/// Notes that the contacts of a state were listed for where everything is now.
void begin_list(State& state);

/// A new near list for a state in motion, from where its bodies are.
void renew_list(State& state, double reach);

}  // namespace eigengrain::assembly
