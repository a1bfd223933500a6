#include "gpu/program_files.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdlib>
#include <cstring>
#include <span>
#include <string_view>
#include <vector>

#include "base/fnv.h"

namespace aspic::gl {
namespace {

namespace fs = std::filesystem;

/// Files start with this line and the key, so that neither another format nor a renamed file is taken.
constexpr std::string_view mark = "aspic program 1\n";
constexpr std::string_view ending = ".program";
/// No program of ours comes near it: a wrong file must not fill the memory.
constexpr std::uint64_t largest_file = std::uint64_t{32} << 20;

struct Tail {
  std::uint64_t format;
  std::uint64_t checksum;  // of everything before it
};

std::uint64_t checksum(std::string_view text, std::uint64_t format) {
  Fnv1a hash;
  hash.add_bytes(std::as_bytes(std::span(text)));
  hash.add(format);
  return hash.value();
}

std::string contents(const std::string& key, const ProgramBinary& binary) {
  std::string text = fmt::format("{}{}\n", mark, key);
  text += binary.bytes;
  const Tail tail = {binary.format, checksum(text, binary.format)};
  text.append(reinterpret_cast<const char*>(&tail), sizeof tail);
  return text;
}

/// Closes the descriptor.
std::optional<std::string> read_all(int descriptor, std::uint64_t size) {
  std::string text(size, '\0');
  std::uint64_t done = 0;
  while (done < size) {
    const ssize_t got = ::read(descriptor, text.data() + done, size - done);
    if (got <= 0) break;
    done += static_cast<std::uint64_t>(got);
  }
  // Its time of modification says when it was last used.
  if (done == size) (void)::futimens(descriptor, nullptr);
  ::close(descriptor);
  if (done < size) return std::nullopt;
  return text;
}

bool write_all(int descriptor, std::string_view text) {
  while (!text.empty()) {
    const ssize_t written = ::write(descriptor, text.data(), text.size());
    if (written <= 0) return false;
    text.remove_prefix(static_cast<std::size_t>(written));
  }
  return true;
}

void make_folders(const fs::path& folder) {
  fs::path made;
  for (const fs::path& part : folder) {
    made /= part;
    (void)::mkdir(made.c_str(), 0700);
  }
}

struct KeptFile {
  fs::path path;
  std::uint64_t bytes = 0;
  fs::file_time_type used;
};

/// Of the folder, those that are ours: complete ones, and what a process left that was killed as it wrote.
std::vector<KeptFile> files_in(const fs::path& folder) {
  std::vector<KeptFile> files;
  std::error_code error;
  for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error)) {
    std::error_code gone;
    if (at->path().extension() != ending || !at->is_regular_file(gone)) continue;
    KeptFile file = {at->path(), at->file_size(gone), {}};
    if (!gone) file.used = at->last_write_time(gone);
    if (!gone) files.push_back(std::move(file));
  }
  return files;
}

}  // namespace

fs::path program_folder() {
  const char* const wish = std::getenv("ASPIC_SHADER_CACHE");
  if (wish && *wish) return std::string_view(wish) == "off" ? fs::path() : fs::path(wish);
  // The base directory specification takes absolute paths alone.
  const char* const cache = std::getenv("XDG_CACHE_HOME");
  if (cache && cache[0] == '/') return fs::path(cache) / "aspic/programs";
  const char* const home = std::getenv("HOME");
  return home && home[0] == '/' ? fs::path(home) / ".cache/aspic/programs" : fs::path();
}

std::optional<ProgramBinary> ProgramFiles::load(const std::string& key) const {
  if (folder_.empty()) return std::nullopt;
  const fs::path path = folder_ / (key + std::string(ending));
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY);
  if (descriptor < 0) return std::nullopt;
  struct stat found = {};
  const std::size_t head = mark.size() + key.size() + 1;
  // A binary is code that the driver carries out: only what is the user's own may decide it.
  if (::fstat(descriptor, &found) != 0 || !S_ISREG(found.st_mode) || found.st_uid != ::geteuid() ||
      (found.st_mode & (S_IWGRP | S_IWOTH)) != 0 ||
      static_cast<std::uint64_t>(found.st_size) <= head + sizeof(Tail) ||
      static_cast<std::uint64_t>(found.st_size) > largest_file) {
    ::close(descriptor);
    return std::nullopt;
  }
  const auto text = read_all(descriptor, static_cast<std::uint64_t>(found.st_size));
  if (!text) return std::nullopt;
  std::string_view rest = *text;
  Tail tail;
  std::memcpy(&tail, rest.data() + rest.size() - sizeof tail, sizeof tail);
  rest.remove_suffix(sizeof tail);
  if (checksum(rest, tail.format) != tail.checksum) return std::nullopt;
  if (!rest.starts_with(mark) || rest.substr(mark.size(), key.size()) != key) return std::nullopt;
  return ProgramBinary{static_cast<std::uint32_t>(tail.format), std::string(rest.substr(head))};
}

void ProgramFiles::store(const std::string& key, const ProgramBinary& binary) {
  if (folder_.empty() || binary.bytes.empty()) return;
  const std::string text = contents(key, binary);
  rlimit limit = {};
  // The system may end a process that writes beyond its limit.
  if (::getrlimit(RLIMIT_FSIZE, &limit) != 0 || text.size() > limit.rlim_cur) return;
  if (text.size() > std::min(largest_file, most_bytes_)) return;
  make_folders(folder_);
  static std::atomic<unsigned> counter{0};
  const fs::path written = folder_ / fmt::format(".{}-{}{}", ::getpid(), counter++, ending);
  const int descriptor = ::open(written.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
  if (descriptor < 0) return;
  const bool complete = write_all(descriptor, text);
  const bool closed = ::close(descriptor) == 0;
  if (!complete || !closed ||
      ::rename(written.c_str(), (folder_ / (key + std::string(ending))).c_str()) != 0) {
    ::unlink(written.c_str());
    return;
  }
  if (bytes_)
    *bytes_ += text.size();
  else
    bytes_ = bytes();
  if (*bytes_ <= most_bytes_) return;
  prune();
  bytes_.reset();
}

std::uint64_t ProgramFiles::bytes() const {
  std::uint64_t sum = 0;
  for (const KeptFile& file : files_in(folder_)) sum += file.bytes;
  return sum;
}

/// Leaves three quarters of the bound, so that the folder is not listed again at once.
void ProgramFiles::prune() const {
  std::vector<KeptFile> files = files_in(folder_);
  std::ranges::sort(files, std::ranges::greater(), &KeptFile::used);
  std::uint64_t sum = 0;
  for (const KeptFile& file : files) {
    sum += file.bytes;
    if (sum > most_bytes_ / 4 * 3) ::unlink(file.path.c_str());
  }
}

}  // namespace aspic::gl
