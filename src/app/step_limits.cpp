#include "step_limits.hpp"

#include "eigengrain/assembly/surroundings.hpp"
#include "eigengrain/io/mode_file.hpp"

#include "text.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

namespace eigengrain::app {
namespace {

using nlohmann::ordered_json;
using timestep::LimitingMode;
using timestep::LimitingModes;
using timestep::LowModes;
using timestep::SelectiveLift;

/// Carriers that are named in the text; JSON has them all.
constexpr std::size_t named = 3;

bool is_clump(const assembly::Model& model, std::int32_t row) {
  return model.bodies.clumps.of(row) != model::Clumps::none;
}

/// The number of the body in the scene.
std::int64_t number_of(const assembly::Model& model, std::int32_t row) {
  const model::Clumps& clumps = model.bodies.clumps;
  return is_clump(model, row) ? clumps.identity[static_cast<std::size_t>(clumps.of(row))]
                              : model.bodies.identity[static_cast<std::size_t>(row)];
}

/// {"ball": 7} or {"clump": 2}
ordered_json body(const assembly::Model& model, std::int32_t row) {
  return {{is_clump(model, row) ? "clump" : "ball", number_of(model, row)}};
}

std::string body_text(const assembly::Model& model, std::int32_t row) {
  return fmt::format("{} {}", is_clump(model, row) ? "clump" : "ball", number_of(model, row));
}

std::string contact_text(const assembly::Model& model, const timestep::CarryingContact& contact) {
  const std::string other = contact.b == contact::no_body
                                ? assembly::wall_names(model)[static_cast<std::size_t>(contact.wall)]
                                : body_text(model, contact.b);
  return body_text(model, contact.a) + " and " + other;
}

ordered_json to_json(const timestep::CarryingContact& contact, const assembly::Model& model) {
  ordered_json second =
      contact.b == contact::no_body
          ? ordered_json{{"wall", assembly::wall_names(model)[static_cast<std::size_t>(contact.wall)]}}
          : body(model, contact.b);
  return {{"between", {body(model, contact.a), std::move(second)}},
          {"kn", contact.stiffness.normal},
          {"ks", contact.stiffness.shear},
          {"share", contact.share}};
}

ordered_json to_json(const LimitingMode& mode, const assembly::Model& model) {
  ordered_json bodies = ordered_json::array();
  for (const timestep::CarryingBody& carrier : mode.bodies) {
    ordered_json entry = body(model, carrier.row);
    const Vec3& place = model::centre_of(model.bodies, carrier.row);
    entry["place"] = {place.x(), place.y(), place.z()};
    entry["share"] = carrier.share;
    bodies.push_back(std::move(entry));
  }
  ordered_json contacts = ordered_json::array();
  for (const timestep::CarryingContact& carrier : mode.contacts) contacts.push_back(to_json(carrier, model));
  return {{"lambda", mode.lambda},           {"dt", mode.dt},
          {"residual", mode.residual},       {"participation", mode.participation},
          {"translation", mode.translation}, {"bodies", std::move(bodies)},
          {"contacts", std::move(contacts)}};
}

/// "ball 7 0.41, ball 9 0.2, and 4 more"
template <class Carrier, class Name>
std::string list(const std::vector<Carrier>& carriers, const Name& name) {
  std::string text;
  for (std::size_t k = 0; k < std::min(named, carriers.size()); ++k)
    text += fmt::format("{}{} {:.2f}", k == 0 ? "" : ", ", name(carriers[k]), carriers[k].share);
  if (carriers.size() > named) text += fmt::format(", and {} more", carriers.size() - named);
  return text;
}

std::string_view proof_of(const SelectiveLift& lift) {
  return lift.by_eigenvalue ? timestep::name_of(lift.after.limit_proof.by) : "weights";
}

/// Relative change of the frequency of each of the slowest modes.
std::vector<double> changes(const SelectiveLift& lift) {
  std::vector<double> result;
  const std::size_t both = std::min(lift.low_before.lambda.size(), lift.low_after.lambda.size());
  for (std::size_t k = 0; k < both; ++k)
    result.push_back(std::sqrt(lift.low_after.lambda[k] / lift.low_before.lambda[k]) - 1);
  return result;
}

}  // namespace

ordered_json to_json(const LimitingModes& limits, const assembly::Model& model) {
  ordered_json modes = ordered_json::array();
  for (const LimitingMode& mode : limits.modes) modes.push_back(to_json(mode, model));
  ordered_json report{{"modes", std::move(modes)}};
  if (!limits.modes.empty()) {
    report["heavier"] = {{"bodies", limits.carrying_bodies}, {"dt", limits.dt_heavier}};
    report["softer"] = {{"contacts", limits.carrying_contacts}, {"dt", limits.dt_softer}};
  }
  report["seconds"] = limits.seconds;
  return report;
}

void print(const LimitingModes& limits, const assembly::Model& model) {
  if (limits.modes.empty()) return;
  fmt::print("\n{:<10} {:>14} {:>9} {:>7} {:>8}  {}\n", "limited by", "dt [s]", "of true", "bodies",
             "turning", "carried by (share of the energy)");
  const double first = limits.modes.front().dt;
  for (std::size_t k = 0; k < limits.modes.size(); ++k) {
    const LimitingMode& mode = limits.modes[k];
    fmt::print("{:<10} {:>14.8e} {:>9.4f} {:>7.1f} {:>7.0f}%  {}\n", fmt::format("mode {}", k + 1), mode.dt,
               mode.dt / first, mode.participation, 100 * (1 - mode.translation),
               list(mode.bodies, [&](const auto& carrier) { return body_text(model, carrier.row); }));
    fmt::print("{:<52}  {}\n", "",
               list(mode.contacts, [&](const auto& carrier) { return contact_text(model, carrier); }));
  }
  fmt::print(
      "with twice the mass of {} the true step is {:.6e} s, {:.4f} of what it is;\n"
      "with half the stiffness of {} {:.6e} s, {:.4f}\n",
      counted(limits.carrying_bodies, "carrying body", "carrying bodies"), limits.dt_heavier,
      limits.dt_heavier / first, counted(limits.carrying_contacts, "contact", "contacts"), limits.dt_softer,
      limits.dt_softer / first);
}

ordered_json to_json(const SelectiveLift& lift, const assembly::Model& model) {
  ordered_json bodies = ordered_json::array();
  for (std::int32_t row = 0; row < model.bodies.size(); ++row) {
    const double factor = lift.lift.factor[static_cast<std::size_t>(row)];
    if (factor == 1) continue;
    bodies.push_back(body(model, row));
    bodies.back()["factor"] = factor;
  }
  ordered_json slow = ordered_json::array();
  const std::vector<double> change = changes(lift);
  for (std::size_t k = 0; k < change.size(); ++k)
    slow.push_back({{"lambda", lift.low_before.lambda[k]},
                    {"lambda_after", lift.low_after.lambda[k]},
                    {"frequency_change", change[k]},
                    {"residual", std::max(lift.low_before.residual[k], lift.low_after.residual[k])}});
  return {{"dt", lift.wished},
          {"limit_before", lift.limit_before},
          {"limit", lift.after.limit},
          {"proof", proof_of(lift)},
          {"mass", lift.mass},
          {"added", lift.lift.added},
          {"added_part", lift.lift.added / lift.mass},
          {"largest_factor", lift.lift.largest},
          {"added_by_weights", lift.added_by_weights},
          {"added_differential", lift.added_differential},
          {"added_uniform", lift.added_uniform},
          {"bodies", std::move(bodies)},
          {"slow_modes", lift.low_left_out.empty() ? std::move(slow) : ordered_json(nullptr)},
          {"seconds", lift.seconds}};
}

void print(const SelectiveLift& lift) {
  const auto percent = [&](double added) { return fmt::format("{:.3g}%", 100 * added / lift.mass); };
  fmt::print(
      "\nFor a step of {:.6e} s ({:.3f} of the limit) {} become heavier, by {:.3g} times at most: {} of mass "
      "is added.\nThe true limit is then {:.6e} s; proven by {}.\n",
      lift.wished, lift.wished / lift.limit_before,
      counted(lift.lift.heavier, "body has to", "bodies have to"), lift.lift.largest,
      percent(lift.lift.added), lift.after.limit,
      proof_of(lift) == "cholesky" ? "a factorisation" : "weights of the bodies");
  fmt::print(
      "otherwise: {} with weights of the bodies as the only proof; {} each body by its own block "
      "(differential); {} all alike (uniform)\n",
      percent(lift.added_by_weights), percent(lift.added_differential), percent(lift.added_uniform));
  if (!lift.low_left_out.empty()) {
    fmt::print("the slowest modes are not computed: {}\n", lift.low_left_out);
    return;
  }
  std::string text;
  for (const double change : changes(lift))
    text += fmt::format("{}{:.2g}%", text.empty() ? "" : ", ", 100 * change);
  if (!text.empty()) fmt::print("the frequencies of the slowest modes change by {}\n", text);
}

void write_modes(const std::string& file, const LimitingModes& limits, const assembly::Model& model) {
  std::vector<io::ModeShape> shapes;
  for (const LimitingMode& mode : limits.modes)
    shapes.push_back({mode.displacement, mode.rotation, mode.energy});
  io::write_modes(file, model.bodies, shapes);
}

}  // namespace eigengrain::app
