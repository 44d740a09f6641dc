#include "equilibrium_report.hpp"

#include "eigengrain/assembly/bonds.hpp"
#include "eigengrain/assembly/forces.hpp"
#include "eigengrain/base/text.hpp"
#include "eigengrain/measures/acting_contacts.hpp"

#include "text.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <vector>

namespace eigengrain::app {

ContactStatuses statuses_of(const assembly::State& state) {
  const assembly::Model& model = state.model;
  const std::vector<measures::ActingContact> contacts = measures::acting_contacts(model);
  ContactStatuses statuses{.bonded = assembly::count_bonds(model)};
  const auto acting = static_cast<std::int64_t>(contacts.size());
  statuses.slipping = std::ranges::count_if(contacts, &measures::ActingContact::slides);
  statuses.sticking = std::max<std::int64_t>(0, acting - statuses.slipping - statuses.bonded);
  statuses.open = std::max<std::int64_t>(0, model.contacts.size() - acting);
  const std::vector<bool> rattles = measures::rattlers(model, contacts, measures::least_contacts(model));
  for (std::int32_t row = 0; row < model.bodies.size(); ++row)
    if (model.bodies.clumps.owner(row) == row && rattles[static_cast<std::size_t>(row)]) ++statuses.rattlers;
  return statuses;
}

nlohmann::ordered_json to_json(const ContactStatuses& statuses) {
  return {{"sticking", statuses.sticking},
          {"slipping", statuses.slipping},
          {"bonded", statuses.bonded},
          {"open", statuses.open},
          {"rattlers", statuses.rattlers}};
}

std::string text_of(const ContactStatuses& statuses) {
  std::string text =
      fmt::format("contacts: {} stick, {} slip", grouped(statuses.sticking), grouped(statuses.slipping));
  if (statuses.bonded > 0) text += fmt::format(", {} bonded", grouped(statuses.bonded));
  text += fmt::format(", {} open within the list", grouped(statuses.open));
  if (statuses.rattlers > 0) text += fmt::format("; {}", counted(statuses.rattlers, "rattler", "rattlers"));
  return text;
}

nlohmann::ordered_json reactions_of(const assembly::State& state) {
  const std::vector<assembly::WallLoad> loads = assembly::wall_loads(state.model);
  const std::vector<model::Plane>& planes = state.model.walls;
  const auto numbers = [](const Vec3& v) { return nlohmann::ordered_json{v.x(), v.y(), v.z()}; };
  nlohmann::ordered_json reactions = nlohmann::ordered_json::array();
  for (std::size_t w = 0; w < loads.size(); ++w)
    reactions.push_back(
        {{"wall", w < planes.size() ? planes[w].name : state.model.surfaces[w - planes.size()].name},
         {"force", numbers(loads[w].force)},
         {"moment", numbers(loads[w].moment)}});
  return reactions;
}

}  // namespace eigengrain::app
