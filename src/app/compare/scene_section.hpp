#pragma once

#include "compared_scene.hpp"
#include "report/page.hpp"
#include "verdict.hpp"

#include <string>

/// One scene on the page of `compare timesteps`, and what all sections of it share.
namespace eigengrain::app {

/// Three digits behind the point; just above 1 the order of what is too much.
std::string ratio_text(double ratio);

/// Error against cost as a picture, and a table; with or without the sources of the estimates.
void add_scene(const ComparedScene& scene, bool with_sources, report::Page& page);

}  // namespace eigengrain::app
