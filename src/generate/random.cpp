#include "eigengrain/generate/random.hpp"

#include "elementary.hpp"

#include <cmath>

namespace eigengrain::generate {

double Random::normal() {
  while (true) {
    const double x = 2 * uniform() - 1;
    const double y = 2 * uniform() - 1;
    const double s = x * x + y * y;
    if (s < 1 && s > 0) return x * std::sqrt(-2 * elementary::log(s) / s);
  }
}

}  // namespace eigengrain::generate
