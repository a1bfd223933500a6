#include <fmt/format.h>

#include <optional>

#include "io/child_process.h"
#include "io/film_format.h"

namespace aspic {
namespace {

/// ffmpeg's options up to the size of the pictures it reads.
constexpr const char* raw_input[] = {"ffmpeg",   "-hide_banner",  "-nostdin", "-loglevel",
                                     "error",    "-xerror",       "-y",       "-f",
                                     "rawvideo", "-pixel_format", "rgb24",    "-video_size"};

class VideoFile : public FrameSink {
 public:
  VideoFile(AtomicFile file, ChildProcess ffmpeg) : file_(std::move(file)), ffmpeg_(std::move(ffmpeg)) {}

  Status write(std::span<const std::byte> rgb) override {
    if (!ffmpeg_) return failure({});
    if (ffmpeg_->write(rgb)) return {};
    return failure(ffmpeg_->finish());
  }

  Status finish() override {
    if (!ffmpeg_) return failure({});
    const ChildProcess::End end = ffmpeg_->finish();
    if (!end.ok()) return failure(end);
    return file_->commit();
  }

  const std::string& path() const override { return file_ ? file_->path() : path_; }

 private:
  Error failure(const ChildProcess::End& end) {
    if (ffmpeg_) {
      const std::string how = end.signal != 0 ? fmt::format("was ended by signal {}", end.signal)
                                              : fmt::format("ended with exit code {}", end.exit_code);
      const std::string said = ffmpeg_->last_lines(6);
      path_ = file_->path();
      reason_ = fmt::format(
          "the video {} could not be made: ffmpeg {}{}{}Check the disk and that ffmpeg has the encoder (the "
          "Debian package ffmpeg has it), or write numbered pictures instead (--frames).",
          path_, how, said.empty() ? " without a message." : fmt::format(" and said\n{}", said),
          said.empty() ? " " : "");
      ffmpeg_.reset();
      file_.reset();  // removes the temporary file
    }
    return {ErrorCode::io, reason_};
  }

  std::optional<AtomicFile> file_;
  std::optional<ChildProcess> ffmpeg_;
  std::string path_, reason_;
};

}  // namespace

Result<std::unique_ptr<FrameSink>> open_video(const std::string& path, const FilmFormat& format,
                                              const PictureSize& size, double fps, Overwrite overwrite) {
  ASPIC_TRY(auto file, AtomicFile::create(path, overwrite));
  if (file.temporary_path().empty())
    return fail(ErrorCode::io, "{} is a device or a pipe, but a video needs a file.", path);
  std::vector<std::string> words(std::begin(raw_input), std::end(raw_input));
  words.insert(words.end(), {fmt::format("{}x{}", size.width, size.height), "-framerate",
                             fmt::format("{}", fps), "-i", "pipe:0", "-an"});
  if (format.even_sides) {
    // sRGB in, BT.709 video range out.
    words.insert(
        words.end(),
        {"-vf", "scale=out_color_matrix=bt709:out_range=tv:flags=accurate_rnd,format=yuv420p", "-colorspace",
         "bt709", "-color_primaries", "bt709", "-color_trc", "iec61966-2-1", "-color_range", "tv"});
  }
  words.insert(words.end(), format.ffmpeg.begin(), format.ffmpeg.end());
  words.push_back("file:" + file.temporary_path());
  auto ffmpeg = ChildProcess::start(words);
  if (!ffmpeg)
    return fail(ErrorCode::io,
                "the video {} cannot be made: {} Videos need the program ffmpeg on PATH: install it with apt "
                "install ffmpeg, or write numbered pictures instead (--frames).",
                path, ffmpeg.error().message);
  return std::unique_ptr<FrameSink>(std::make_unique<VideoFile>(std::move(file), std::move(*ffmpeg)));
}

}  // namespace aspic
