#include "io/spool.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <stdlib.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <utility>

#include "base/files.h"

namespace aspic {

Result<Spool> Spool::create(const std::string& path) {
  Spool spool;
  spool.path_ = path;
  std::string directory = std::filesystem::path(path).parent_path();
  if (directory.empty()) directory = ".";
  spool.descriptor_ = ::open(directory.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0600);
  if (spool.descriptor_ < 0) {  // a file system without files that have no name
    std::string name = directory + "/.aspic-XXXXXX.tmp";
    spool.descriptor_ = ::mkostemps(name.data(), 4, O_CLOEXEC);
    if (spool.descriptor_ < 0) return file_error("write", path, errno);
    ::unlink(name.c_str());
  }
  return spool;
}

Spool::Spool(Spool&& other) noexcept {
  *this = std::move(other);
}

Spool& Spool::operator=(Spool&& other) noexcept {
  std::swap(path_, other.path_);
  std::swap(descriptor_, other.descriptor_);
  std::swap(size_, other.size_);
  return *this;
}

Spool::~Spool() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

Status Spool::append(std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::pwrite(descriptor_, bytes.data(), bytes.size(), static_cast<off_t>(size_));
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return file_error("write", path_, errno);
    bytes.remove_prefix(static_cast<std::size_t>(written));
    size_ += static_cast<std::uint64_t>(written);
  }
  return {};
}

Status Spool::read(std::uint64_t offset, std::string& bytes) const {
  for (std::size_t done = 0; done < bytes.size();) {
    const ssize_t got =
        ::pread(descriptor_, bytes.data() + done, bytes.size() - done, static_cast<off_t>(offset + done));
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return file_error("write", path_, got < 0 ? errno : EIO);
    done += static_cast<std::size_t>(got);
  }
  return {};
}

}  // namespace aspic
