#pragma once

#include "eigengrain/timestep/comparison.hpp"

#include "report/chart.hpp"

/// What is to be thought of an estimate in a scene, in words and as a mark.
namespace eigengrain::app {

enum class Verdict { proven, probable, safe_here, unsafe };

Verdict verdict_on(const timestep::Estimate& estimate);
const char* text_of(Verdict verdict);
report::Look look_of(Verdict verdict);

}  // namespace eigengrain::app
