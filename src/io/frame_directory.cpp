#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <filesystem>
#include <utility>
#include <vector>

#include "io/video_format.h"

namespace aspic {
namespace {

namespace fs = std::filesystem;

/// frame-, six digits or more, the ending of an image format.
bool is_frame_name(const std::string& name) {
  const fs::path path(name);
  const std::string stem = path.stem().string();
  const VideoFormat* const format = find_video_format(path.extension().string());
  if (!format || !format->is_directory() || path.extension() != format->ending) return false;
  return stem.size() >= 12 && stem.starts_with("frame-") &&
         std::all_of(stem.begin() + 6, stem.end(), [](unsigned char c) { return std::isdigit(c) != 0; });
}

Result<std::vector<fs::path>> frames_in(const std::string& directory) {
  std::vector<fs::path> frames;
  std::error_code failed;
  for (fs::directory_iterator it(directory, failed), end; !failed && it != end; it.increment(failed))
    if (is_frame_name(it->path().filename().string())) frames.push_back(it->path());
  if (failed) return file_error("read the directory", directory, failed.value());
  return frames;
}

class FrameDirectory : public FrameSink {
 public:
  FrameDirectory(std::string directory, const VideoFormat& format, const ImageSize& size,
                 std::vector<fs::path> earlier)
      : directory_(std::move(directory)), format_(format), size_(size), earlier_(std::move(earlier)) {}

  Status write(std::span<const std::byte> rgb) override {
    ASPIC_TRY(const auto content, format_.encode(size_, rgb));
    const std::string name = fmt::format("{}/frame-{:06}{}", directory_, next_, format_.ending);
    ASPIC_TRY(auto file, AtomicFile::create(name, earlier_.empty() ? Overwrite::refuse : Overwrite::allow));
    ASPIC_CHECK(file.write(content));
    ASPIC_CHECK(file.commit());
    ++next_;
    // The first image has replaced one of its name; the others go.
    for (const fs::path& frame : std::exchange(earlier_, {}))
      if (frame.filename() != fs::path(name).filename() && ::unlink(frame.c_str()) != 0)
        return file_error("remove", frame.string(), errno);
    return {};
  }

  Status finish() override { return {}; }
  const std::string& path() const override { return directory_; }

 private:
  std::string directory_;
  const VideoFormat& format_;
  ImageSize size_;
  std::vector<fs::path> earlier_;  // images of another run
  std::uint64_t next_ = 0;
};

}  // namespace

Result<std::unique_ptr<FrameSink>> open_frame_directory(const std::string& directory,
                                                        const VideoFormat& format, const ImageSize& size,
                                                        Overwrite overwrite) {
  if (::mkdir(directory.c_str(), 0777) != 0 && errno != EEXIST)
    return file_error("make the directory", directory, errno);
  struct stat present = {};
  if (::stat(directory.c_str(), &present) != 0) return file_error("read the directory", directory, errno);
  if (!S_ISDIR(present.st_mode))
    return fail(ErrorCode::io, "{} is a file, but frames need a directory. Choose another name.", directory);
  if (::access(directory.c_str(), W_OK | X_OK) != 0) return file_error("write into", directory, errno);
  ASPIC_TRY(const auto frames, frames_in(directory));
  if (!frames.empty() && overwrite == Overwrite::refuse)
    return advised(fail(ErrorCode::io, "{} already contains frames ({} and others) and was not changed.",
                        directory, std::min_element(frames.begin(), frames.end())->filename().string()),
                   {advice("choose another directory"), {RemedyKind::overwrite}});
  return std::unique_ptr<FrameSink>(std::make_unique<FrameDirectory>(directory, format, size, frames));
}

}  // namespace aspic
