#include "eigengrain/base/assert.hpp"

#include <cstdio>
#include <cstdlib>

namespace eigengrain::detail {

void assertion_failed(const char* condition, const char* file, int line, const char* names,
                      const std::string& values) {
  std::fprintf(stderr, "%s:%d: eigengrain is wrong about itself: %s\n", file, line, condition);
  if (!values.empty()) std::fprintf(stderr, "  %s = %s\n", names, values.c_str());
  std::abort();
}

}  // namespace eigengrain::detail
