#pragma once

#include <filesystem>
#include <span>

namespace eigengrain::io {

/// A file that is written beside its target and takes its place only when it is complete. Unless published
/// it is gone at the end, and the target is as it was. Failures are InputErrors that name the target.
class PartFile {
 public:
  explicit PartFile(const std::filesystem::path& target);
  ~PartFile();
  PartFile(const PartFile&) = delete;
  PartFile& operator=(const PartFile&) = delete;

  void write(std::span<const char> bytes) const;
  /// Renames to the target. What was written is on the disk before, the new name after.
  void publish();

 private:
  std::filesystem::path target_;
  std::filesystem::path path_;
  int descriptor_ = -1;
  bool published_ = false;
};

}  // namespace eigengrain::io
