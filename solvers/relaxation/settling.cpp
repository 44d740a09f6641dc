#include "settling.hpp"

#include "eigengrain/measures/acting_contacts.hpp"

#include <algorithm>
#include <cstdlib>

namespace eigengrain::relaxation {
namespace {

/// Largest over mean ratio where bodies still fall or roll: there Newton is asked in vain. What stands out by
/// no more than the least ratio from there does no harm.
constexpr double settled_max = 50;
constexpr double least_mean = 1e-7;

/// Part of the acting contacts that may have changed.
constexpr double few_changes = 0.001;

}  // namespace

double mean_of(const assembly::Balance& balance) {
  return std::max(balance.mean, balance.moment_mean);
}

bool at_rest_within(const assembly::Balance& balance, double ratio) {
  return balance.unsupported == 0 && mean_of(balance) <= ratio;
}

bool settled_within(const assembly::Balance& balance, double ratio) {
  return at_rest_within(balance, ratio) &&
         std::max(balance.max, balance.moment_max) <= settled_max * std::max(mean_of(balance), least_mean);
}

ContactCounts count_contacts(const assembly::Model& model) {
  ContactCounts counts;
  for (const measures::ActingContact& contact : measures::acting_contacts(model)) {
    ++counts.acting;
    if (contact.slides) ++counts.sliding;
  }
  return counts;
}

bool stays(const ContactCounts& before, const ContactCounts& now) {
  const std::int64_t changes = std::abs(now.acting - before.acting) + std::abs(now.sliding - before.sliding);
  return static_cast<double>(changes) <= few_changes * static_cast<double>(now.acting);
}

}  // namespace eigengrain::relaxation
