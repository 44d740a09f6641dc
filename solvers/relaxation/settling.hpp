#pragma once

#include "eigengrain/assembly/balance.hpp"
#include "eigengrain/assembly/state.hpp"

#include <cstdint>

/// When a state counts as one at rest, and as one that Newton's method may be asked about.
namespace eigengrain::relaxation {

/// The larger mean unbalanced ratio, of forces or moments.
double mean_of(const assembly::Balance& balance);

/// Mean ratios are within this, and nothing is unsupported.
bool at_rest_within(const assembly::Balance& balance, double ratio);

/// And no body stands out so far from the mean that it must be falling or rolling.
bool settled_within(const assembly::Balance& balance, double ratio);

/// How contacts stand at a moment: what changes while they open, close and slip.
struct ContactCounts {
  std::int64_t acting = 0;
  std::int64_t sliding = 0;
};
ContactCounts count_contacts(const assembly::Model& model);

/// Whether so few contacts have changed between two looks that the next ones will find much the same.
bool stays(const ContactCounts& before, const ContactCounts& now);

}  // namespace eigengrain::relaxation
