#include "part_file.hpp"

#include "eigengrain/base/error.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <string>
#include <system_error>
#include <utility>

namespace eigengrain::io {
namespace {

namespace fs = std::filesystem;

fs::path folder_of(const fs::path& file) {
  return file.has_parent_path() ? file.parent_path() : fs::path(".");
}

std::string what_to_do(int error, const fs::path& target) {
  switch (error) {
    case ENOENT:
    case ENOTDIR:
      return fmt::format("; there is no folder \"{}\", make it first", folder_of(target).string());
    case ENOSPC:
    case EDQUOT:
      return "; make room there or choose another folder";
    case EACCES:
    case EPERM:
    case EROFS:
      return "; choose a folder that you may write to";
    default:
      return {};
  }
}

[[noreturn]] void fail(const fs::path& target, int error) {
  throw InputError({{target.string(), 0,
                     fmt::format("cannot be written: {}{}", std::generic_category().message(error),
                                 what_to_do(error, target))}});
}

/// A rename lasts only when its folder is on the disk.
void sync_folder(const fs::path& target) {
  const int folder = ::open(folder_of(target).c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (folder < 0) return;  // a folder may be writable and yet not readable
  const int error = ::fsync(folder) == 0 ? 0 : errno;
  ::close(folder);
  if (error != 0 && error != EINVAL && error != ENOTSUP) fail(target, error);
}

}  // namespace

PartFile::PartFile(const fs::path& target) : target_(target), path_(target) {
  std::error_code ignored;
  if (fs::is_directory(target, ignored)) fail(target, EISDIR);
  path_ += fmt::format(".part-{}", ::getpid());
  descriptor_ = ::open(path_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (descriptor_ < 0) fail(target_, errno);
}

PartFile::~PartFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
  std::error_code ignored;
  if (!published_) fs::remove(path_, ignored);
}

void PartFile::write(std::span<const char> bytes) const {
  while (!bytes.empty()) {
    const ssize_t written = ::write(descriptor_, bytes.data(), bytes.size());
    if (written >= 0)
      bytes = bytes.subspan(static_cast<std::size_t>(written));
    else if (errno != EINTR)
      fail(target_, errno);
  }
}

void PartFile::publish() {
  if (::fsync(descriptor_) != 0) fail(target_, errno);
  if (::close(std::exchange(descriptor_, -1)) != 0) fail(target_, errno);
  if (::rename(path_.c_str(), target_.c_str()) != 0) fail(target_, errno);
  published_ = true;
  sync_folder(target_);
}

}  // namespace eigengrain::io
