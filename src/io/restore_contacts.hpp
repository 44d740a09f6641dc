#pragma once

#include "eigengrain/assembly/model.hpp"

#include "hdf5.hpp"

#include <string>

namespace eigengrain::io {

/// The contacts of a state file, with the laws that the settings give them now. Where a law now wants a
/// history of other parts than the file has (friction that is switched on), contacts are as just formed.
///
/// model  has its bodies, walls and cell
/// name   of the file, for messages
///
/// Throws InputError where the settings do not give a group its law, h5::Error where contents do not fit.
contact::Contacts restore_contacts(const h5::File& file, const model::Scene& settings,
                                   const assembly::Model& model, const std::string& name);

}  // namespace eigengrain::io
