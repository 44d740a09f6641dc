#include "atomic_file.hpp"

#include "eigengrain/base/error.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <system_error>
#include <utility>

namespace eigengrain::io {
namespace {

namespace fs = std::filesystem;

/// What to do about it.
std::string remedy(const fs::path& file) {
  std::error_code ignored;
  const fs::path folder = file.parent_path();
  if (!folder.empty() && !fs::exists(folder, ignored))
    return fmt::format("there is no folder \"{}\", make it first", folder.string());
  return "name a folder where there is room and that may be written to";
}

[[noreturn]] void throw_cannot_write(const fs::path& file, std::string_view reason) {
  throw InputError({{file.string(), 0, fmt::format("cannot be written ({}); {}", reason, remedy(file))}});
}

/// A new name is safe only once its folder is on the disk. File systems that cannot do that are left alone.
void sync_folder(const fs::path& folder) {
  const int descriptor = ::open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return;
  ::fsync(descriptor);
  ::close(descriptor);
}

}  // namespace

void throw_cannot_write(const fs::path& file) {
  throw_cannot_write(file, std::strerror(errno));
}

void make_folder(const fs::path& folder) {
  std::error_code error;
  if (!folder.empty()) fs::create_directories(folder, error);
  if (error) throw_cannot_write(folder, error.message());
}

AtomicFile::AtomicFile(fs::path target)
    : target_(std::move(target)),
      beside_(target_.string() + ".part"),
      file_(std::fopen(beside_.c_str(), "wbe")) {
  if (!file_) throw_cannot_write(target_);
}

AtomicFile::~AtomicFile() {
  if (!file_) return;
  std::error_code ignored;  // a name that stays is overwritten the next time
  fs::remove(beside_, ignored);
}

void AtomicFile::write(std::string_view bytes) {
  if (std::fwrite(bytes.data(), 1, bytes.size(), file_.get()) != bytes.size()) throw_cannot_write(target_);
}

void AtomicFile::commit() {
  if (std::fflush(file_.get()) != 0 || ::fsync(::fileno(file_.get())) != 0) throw_cannot_write(target_);
  if (std::rename(beside_.c_str(), target_.c_str()) != 0) throw_cannot_write(target_);
  file_.reset();
  sync_folder(target_.parent_path());
}

}  // namespace eigengrain::io
