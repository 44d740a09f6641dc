#include "eigengrain/io/scene_reader.hpp"
#include "eigengrain/measures/measure.hpp"

#include "input.hpp"
#include "text.hpp"
#include "verbs.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <optional>
#include <string>
#include <vector>

namespace eigengrain::app {
namespace {

using measures::Measure;
using nlohmann::ordered_json;

ordered_json rows(const Mat3& tensor) {
  ordered_json all = ordered_json::array();
  for (int row = 0; row < 3; ++row) all.push_back({tensor(row, 0), tensor(row, 1), tensor(row, 2)});
  return all;
}

/// JSON has no number for a mean of nothing.
ordered_json number_or_null(double value) {
  return std::isnan(value) ? ordered_json() : ordered_json(value);
}

ordered_json to_json(const std::string& name, const Measure& m) {
  const auto tensor_or_null = [](const std::optional<Mat3>& tensor) {
    return tensor && !std::isnan((*tensor)(0, 0)) ? rows(*tensor) : ordered_json();
  };
  return {{"name", name},
          {"volume", m.volume},
          {"bodies", m.fabric.bodies},
          {"porosity", m.porosity},
          {"stress", rows(m.stress)},
          {"velocity_gradient", tensor_or_null(m.velocity_gradient)},
          {"strain_rate", tensor_or_null(m.strain_rate())},
          {"coordination", number_or_null(m.fabric.coordination)},
          {"rattlers", m.fabric.rattlers},
          {"coordination_without_rattlers", number_or_null(m.fabric.without_rattlers)},
          {"fabric", tensor_or_null(m.fabric.tensor)},
          {"sliding", number_or_null(m.fabric.sliding)}};
}

void print_tensor(const char* name, const std::optional<Mat3>& tensor, const char* unit) {
  if (!tensor || std::isnan((*tensor)(0, 0))) {
    fmt::print("  {:<14}open\n", name);
    return;
  }
  const Mat3 t = 0.5 * (*tensor + tensor->transpose());
  fmt::print("  {:<14}xx {:.5g}, yy {:.5g}, zz {:.5g}, xy {:.5g}, xz {:.5g}, yz {:.5g}{}\n", name, t(0, 0),
             t(1, 1), t(2, 2), t(0, 1), t(0, 2), t(1, 2), unit);
}

void print_number(const char* name, double value) {
  fmt::print("  {:<14}{}\n", name, std::isnan(value) ? "open" : fmt::format("{:.5g}", value));
}

void print(const std::string& name, const Measure& m) {
  const measures::Fabric& f = m.fabric;
  fmt::print("{}: {:.5g} m3, {}\n", name, m.volume, counted(f.bodies, "body", "bodies"));
  print_number("porosity", m.porosity);
  print_tensor("stress", m.stress, " Pa");
  fmt::print("  {:<14}{:.5g} Pa (tension positive)\n", "mean stress", m.stress.trace() / 3);
  print_tensor("strain rate", m.strain_rate(), " 1/s");
  print_number("coordination", f.coordination);
  print_number("  of the held", f.without_rattlers);
  fmt::print("  {:<14}{}\n", "rattlers", f.rattlers);
  print_tensor("fabric", f.tensor, "");
  print_number("sliding", f.sliding);
}

}  // namespace

void measure(const Options& options) {
  const Question question = read_question(options);
  std::vector<model::Region> regions =
      options.regions.empty() ? question.settings.measures : io::read_regions(options.regions);
  if (regions.empty()) regions.push_back({"all", {}});
  const std::vector<Measure> found = measures::measure(question.model, regions);
  ordered_json report{{"bodies", question.model.bodies.size()}, {"regions", ordered_json::array()}};
  for (std::size_t k = 0; k < regions.size(); ++k)
    report["regions"].push_back(to_json(regions[k].name, found[k]));
  write_json(options.json, report);
  for (std::size_t k = 0; k < regions.size(); ++k) print(regions[k].name, found[k]);
  print_notes(question.settings);
}

}  // namespace eigengrain::app
