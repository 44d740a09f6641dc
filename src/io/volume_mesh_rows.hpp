#pragma once

#include "eigengrain/model/mesh.hpp"

#include "diagnostics.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace eigengrain::io {

/// What a format calls the parts of a mesh.
struct MeshWords {
  std::string_view node;
  std::string_view element;
};

/// A volume mesh as it is read out of the rows of one file, and its mistakes.
class VolumeMeshRows {
 public:
  VolumeMeshRows(const std::string& name, const MeshWords& words, Diagnostics& diagnostics)
      : name_(name), words_(words), diagnostics_(diagnostics) {}

  /// kind: mistakes of one kind are listed up to a limit.
  void report(std::int32_t line, std::string_view kind, std::string message);
  /// The word as a whole number; reported as a mistake in `what` if it is none.
  std::optional<std::int64_t> integer(std::string_view word, std::string_view what, std::int32_t line);
  /// The first three words as coordinates, or a report.
  std::optional<Vec3> position(std::span<const std::string_view> words, std::int32_t line);

  /// A node whose place was reported keeps its number, so that elements may name it.
  void add_node(std::int64_t number, const std::optional<Vec3>& position, std::int32_t line);
  /// Nodes are missing, which was reported: elements that name what is not there are no mistakes.
  void lose_nodes() { some_lost_ = true; }
  /// Reports an element of another kind than the first one.
  void add_element(std::int64_t number, model::ElementKind kind, std::span<const std::int64_t> nodes,
                   std::int32_t line);
  /// Takes note of points, lines or faces, of which nothing is read.
  void skip_elements(std::int64_t count) { skipped_ += count; }

  std::int64_t elements() const { return std::ssize(element_numbers_); }
  std::int64_t skipped() const { return skipped_; }

  /// The mesh in units of `unit` (m); what is wrong with it is reported if nothing has been so far. Empty if
  /// anything is wrong.
  model::Mesh result(double unit);

 private:
  /// Rows of nodes by their numbers.
  class Index;

  bool find_nodes(const Index& index);
  void keep_used_nodes(double unit);
  void report_problems();

  const std::string& name_;
  MeshWords words_;
  Diagnostics& diagnostics_;
  bool wrong_ = false;      ///< something has been reported
  bool some_lost_ = false;  ///< nodes are missing for a reason that was reported
  bool mixed_ = false;      ///< an element of another kind has been reported
  std::int64_t skipped_ = 0;
  std::vector<Vec3> positions_;             ///< as they stand in the file
  std::vector<std::int64_t> node_numbers_;  ///< of each
  std::vector<std::int32_t> node_lines_;    ///< of each
  std::vector<std::int64_t> element_numbers_;
  std::vector<std::int32_t> element_lines_;
  std::vector<std::int64_t> element_nodes_;  ///< numbers, element after element
  model::Mesh mesh_;
};

}  // namespace eigengrain::io
