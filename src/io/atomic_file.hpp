#pragma once

#include <cstdio>
#include <filesystem>
#include <memory>
#include <string_view>

namespace eigengrain::io {

/// A file that is there in full or not at all: it is written beside its place, as NAME.part, and takes the
/// place of what stood there when it is complete and on the disk. Throws InputError, with the system's
/// reason, where that fails.
class AtomicFile {
 public:
  explicit AtomicFile(std::filesystem::path target);
  /// Without commit, what stood there stays.
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  void write(std::string_view bytes);
  void commit();

 private:
  struct Close {
    // NOLINTNEXTLINE(cppcoreguidelines-owning-memory): the unique_ptr is the owner
    void operator()(std::FILE* file) const { std::fclose(file); }
  };

  std::filesystem::path target_;
  std::filesystem::path beside_;
  std::unique_ptr<std::FILE, Close> file_;
};

/// Makes the folder, and those above it, unless it is there.
void make_folder(const std::filesystem::path& folder);

/// The mistake of a file that cannot be written; the reason is that of errno.
[[noreturn]] void throw_cannot_write(const std::filesystem::path& file);

}  // namespace eigengrain::io
