#include "memory.hpp"

#include "eigengrain/base/error.hpp"

#include <fmt/format.h>

#include <fstream>
#include <limits>
#include <string>

namespace eigengrain::timestep {

double available_memory() {
  std::ifstream file("/proc/meminfo");
  std::string key;
  double kilobytes = 0;
  for (std::string rest; file >> key >> kilobytes; std::getline(file, rest))
    if (key == "MemAvailable:") return 1024 * kilobytes;
  return std::numeric_limits<double>::infinity();
}

void require_memory(double numbers, double available, const char* what, const char* instead) {
  // The factor, and what supernodes are updated in: a tenth of it on packings.
  const double wanted = 1.2 * sizeof(double) * numbers;
  if (wanted > available)
    throw SolverError(
        fmt::format("{} wants a sparse factor of {:.2g} numbers, about {:.1f} GB, and {:.1f} GB of "
                    "memory are free; {}",
                    what, numbers, wanted / 1e9, available / 1e9, instead));
}

}  // namespace eigengrain::timestep
