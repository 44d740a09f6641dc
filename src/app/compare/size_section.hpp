#pragma once

#include "cost_by_size.hpp"
#include "report/page.hpp"

#include <vector>

namespace eigengrain::app {

/// Cost against the number of bodies, as a picture; nothing for fewer than two sizes.
void add_sizes(const std::vector<CostOfSize>& sizes, report::Page& page);

}  // namespace eigengrain::app
