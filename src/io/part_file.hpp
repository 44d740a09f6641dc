#pragma once

#include <cstdint>
#include <filesystem>

namespace eigengrain::io {

/// A file that is written beside its target and takes its place only when it is complete. Unless published
/// it is gone at the end, and the target is as it was. Failures are InputErrors that name the target.
class PartFile {
 public:
  explicit PartFile(const std::filesystem::path& target);
  ~PartFile();
  PartFile(const PartFile&) = delete;
  PartFile& operator=(const PartFile&) = delete;

  const std::filesystem::path& path() const { return path_; }
  /// Takes space on the disk without changing the file's length, so that a full disk shows before anything
  /// is written. Does nothing where the file system cannot.
  void reserve(std::uint64_t bytes) const;
  /// Renames to the target. What was written is on the disk before, the new name after.
  void publish();

 private:
  std::filesystem::path target_;
  std::filesystem::path path_;
  int descriptor_ = -1;
  bool published_ = false;
};

}  // namespace eigengrain::io
