#include "io/shared_memory.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

namespace aspic {
namespace {

Error refused(int reason) {
  return fail(ErrorCode::io, "the memory shared with other processes cannot be made: {}.",
              std::strerror(reason));
}

}  // namespace

Result<SharedMemory> SharedMemory::create(std::uint64_t bytes) {
  SharedMemory memory;
  memory.descriptor_ = ::memfd_create("pictures", MFD_CLOEXEC);
  if (memory.descriptor_ < 0) return refused(errno);
  // Pages that could not be had later would end the process by a signal.
  int failed = 0;
  do failed = ::posix_fallocate(memory.descriptor_, 0, static_cast<off_t>(bytes));
  while (failed == EINTR);
  if (failed != 0) return refused(failed);
  ASPIC_CHECK(memory.map());
  return memory;
}

Result<SharedMemory> SharedMemory::open(int descriptor) {
  SharedMemory memory;
  memory.descriptor_ = descriptor;
  ASPIC_CHECK(memory.map());
  return memory;
}

Status SharedMemory::map() {
  struct stat facts = {};
  if (::fstat(descriptor_, &facts) != 0) return refused(errno);
  const auto size = static_cast<std::size_t>(facts.st_size);
  void* const place = ::mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_SHARED, descriptor_, 0);
  if (place == MAP_FAILED) return refused(errno);
  start_ = static_cast<std::byte*>(place);
  size_ = size;
  return {};
}

SharedMemory::~SharedMemory() {
  if (start_) ::munmap(start_, size_);
  if (descriptor_ >= 0) ::close(descriptor_);
}

SharedMemory::SharedMemory(SharedMemory&& other) noexcept
    : descriptor_(std::exchange(other.descriptor_, -1)),
      start_(std::exchange(other.start_, nullptr)),
      size_(std::exchange(other.size_, 0)) {}

SharedMemory& SharedMemory::operator=(SharedMemory&& other) noexcept {
  std::swap(descriptor_, other.descriptor_);
  std::swap(start_, other.start_);
  std::swap(size_, other.size_);
  return *this;
}

}  // namespace aspic
