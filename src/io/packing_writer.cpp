#include "eigengrain/base/assert.hpp"
#include "eigengrain/io/packing_file.hpp"

#include "atomic_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <string>

namespace eigengrain::io {

void write_packing_file(std::span<const Vec3> centres, std::span<const double> radii,
                        std::string_view comment, const std::filesystem::path& file) {
  EIGENGRAIN_ASSERT(centres.size() == radii.size(), centres.size(), radii.size());
  std::string text;
  while (!comment.empty()) {
    const std::size_t end = std::min(comment.find('\n'), comment.size());
    text += fmt::format("# {}\n", comment.substr(0, end));
    comment.remove_prefix(std::min(end + 1, comment.size()));
  }
  // fmt writes the shortest number that reads back to the same bits.
  for (std::size_t i = 0; i < centres.size(); ++i)
    fmt::format_to(std::back_inserter(text), "{} {} {} {}\n", centres[i][0], centres[i][1], centres[i][2],
                   radii[i]);
  AtomicFile out(file);
  out.write(text);
  out.commit();
}

}  // namespace eigengrain::io
