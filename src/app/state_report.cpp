#include "state_report.hpp"

#include "eigengrain/assembly/energies.hpp"
#include "eigengrain/measures/ledger.hpp"

#include "text.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace eigengrain::app {

void add_balance(nlohmann::ordered_json& report, const assembly::Balance& balance) {
  report["contacts"] = balance.contacts;
  report["unbalanced"] = {{"mean", balance.mean},
                          {"max", balance.max},
                          {"floor", balance.floor},
                          {"moment_mean", balance.moment_mean},
                          {"moment_max", balance.moment_max}};
  report["unsupported"] = balance.unsupported;
}

void add_energies(nlohmann::ordered_json& report, const assembly::State& state) {
  const assembly::Energies e = assembly::energies_of(state);
  report["energies"] = {{"kinetic", e.kinetic}, {"elastic", e.elastic}, {"gravitational", e.gravitational}};
}

void add_ledger(nlohmann::ordered_json& report, const assembly::State& state) {
  nlohmann::ordered_json& all = report["ledger"];
  for (const measures::LedgerEntry& entry : measures::entries_of(measures::ledger_of(state)))
    all[entry.name] = entry.value;
}

std::string balance_text(const assembly::Balance& balance) {
  if (balance.contacts == 0) return "no contact acts";
  return fmt::format(
      "unbalanced ratio: mean {:.3e}, largest {:.3e} (rounding of positions alone makes {:.1e}), {}{}",
      balance.mean, balance.max, balance.floor,
      counted(balance.contacts, "acting contact", "acting contacts"),
      balance.unsupported > 0 ? fmt::format(", {} unsupported", counted(balance.unsupported, "ball", "balls"))
                              : "");
}

}  // namespace eigengrain::app
