#include "size_section.hpp"

#include "eigengrain/base/text.hpp"

#include "../text.hpp"
#include "report/chart.hpp"
#include "verdict.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

namespace eigengrain::app {

using report::Axis;
using report::Mark;
using report::Page;

void add_sizes(const std::vector<CostOfSize>& sizes, Page& page) {
  if (sizes.size() < 2) return;
  page.section("Cost against the number of bodies");
  const std::vector<Growth> growth = growth_of(sizes);
  const auto [least, most] = std::minmax_element(
      growth.begin(), growth.end(), [](const Growth& a, const Growth& b) { return a.exponent < b.exponent; });
  page.paragraph(
      fmt::format("From {} to {} bodies the time grows with exponents between {:.2f} ({}) and {:.2f} ({}); 1 "
                  "is linear, and what no "
                  "longer fits into caches counts as growth.",
                  grouped(sizes_of_growth(sizes).front().bodies), grouped(sizes.back().bodies),
                  least->exponent, least->name, most->exponent, most->name));
  double low = std::numeric_limits<double>::infinity();
  double high = 0;
  report::Chart chart{.title = "Seconds of each estimate against the number of bodies",
                      .x = Axis::logarithmic_with_margins(static_cast<double>(sizes.front().bodies),
                                                          static_cast<double>(sizes.back().bodies)),
                      .y = Axis::logarithmic(1, 2),
                      .x_name = "bodies",
                      .y_name = "seconds",
                      .height = 560};
  for (const Growth& of : growth) {
    report::Series series{
        .name = of.name, .look = {Mark::square, report::colour::grey, false}, .joined = true};
    if (of.name == name_of_product) series.look = {Mark::diamond, report::colour::ink, true};
    if (of.name == name_of_truth) series.look = {Mark::circle, report::colour::ink, true};
    if (const timestep::Estimator* e = timestep::find_estimator(of.name); e != nullptr) {
      if (e->claim == timestep::Claim::proven) series.look = look_of(Verdict::proven);
      if (e->claim == timestep::Claim::probable) series.look = look_of(Verdict::probable);
    }
    for (const CostOfSize& size : sizes) {
      const double seconds = seconds_of(size, of.name);
      series.points.push_back({static_cast<double>(size.bodies), seconds});
      if (!(seconds > 0)) continue;
      low = std::min(low, seconds);
      high = std::max(high, seconds);
    }
    chart.series.push_back(std::move(series));
  }
  chart.y = Axis::logarithmic_with_margins(low, high);
  const auto first = static_cast<double>(sizes.front().bodies);
  const auto last = static_cast<double>(sizes.back().bodies);
  const double start = std::max(chart.y.low() * 1.3, high * 1.2 * first / last);
  const double end = std::min(last, first * chart.y.high() / start);
  chart.guides.push_back({"slope 1", {{first, start}, {end, start * end / first}}});
  page.picture(
      svg_of(chart),
      "Seconds of one answer, on packings of balls of 2 m on a face-centred lattice whose centres and radii "
      "are "
      "disordered so that half of the 12 neighbours touch: the contacts of a settled packing, made in linear "
      "time. Filled circles: proven; filled diamonds: safe but for a stated probability; open squares: "
      "rules; "
      "black: one product with K, and the true step.");
}

}  // namespace eigengrain::app
