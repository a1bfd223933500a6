#include "io/video_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <optional>

#include "io/child_process.h"

namespace aspic {
namespace {

constexpr double gif_fps_limit = 50.0;  // shortest picture that viewers honour: two hundredths of a second

/// What ffmpeg is told about the output; sRGB in, BT.709 video range out.
std::vector<std::string> encoding(VideoFormat format) {
  const std::vector<std::string> colour = {
      "-vf",
      "scale=out_color_matrix=bt709:out_range=tv:flags=accurate_rnd,format=yuv420p",
      "-colorspace",
      "bt709",
      "-color_primaries",
      "bt709",
      "-color_trc",
      "iec61966-2-1",
      "-color_range",
      "tv"};
  std::vector<std::string> words;
  switch (format) {
    case VideoFormat::mp4:
      words = {"-c:v", "libx264", "-preset", "medium", "-crf", "18", "-movflags", "+faststart"};
      words.insert(words.end(), colour.begin(), colour.end());
      words.insert(words.end(), {"-f", "mp4"});
      break;
    case VideoFormat::webm:
      words = {"-c:v",      "libvpx-vp9", "-crf",      "28", "-b:v",    "0",
               "-deadline", "good",       "-cpu-used", "4",  "-row-mt", "1"};
      words.insert(words.end(), colour.begin(), colour.end());
      words.insert(words.end(), {"-f", "webm"});
      break;
    case VideoFormat::gif:
      words = {"-vf",   "split[a][b];[a]palettegen=stats_mode=full[p];[b][p]paletteuse=dither=sierra2_4a",
               "-loop", "0",
               "-f",    "gif"};
      break;
  }
  return words;
}

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
          "the video {} could not be made: ffmpeg {}{}{}Check the disk and that ffmpeg has the encoder "
          "(the Debian package ffmpeg has it), or write numbered pictures instead (--frames).",
          path_, how, said.empty() ? " without a word." : fmt::format(" and said\n{}", said),
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

Result<VideoFormat> video_format_of(const std::string& path) {
  const std::size_t dot = path.rfind('.');
  std::string end = dot == std::string::npos ? "" : path.substr(dot);
  std::ranges::transform(end, end.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (end == ".mp4") return VideoFormat::mp4;
  if (end == ".webm") return VideoFormat::webm;
  if (end == ".gif") return VideoFormat::gif;
  return Error{
      ErrorCode::usage,
      fmt::format("the video's name {} must end in .mp4, .webm or .gif, which says its format.", path)};
}

double default_fps(VideoFormat format) {
  return format == VideoFormat::gif ? gif_fps_limit : 60.0;
}

Status check_video(VideoFormat format, const PictureSize& size, double fps) {
  if (format == VideoFormat::gif) {
    if (fps <= gif_fps_limit) return {};
    return Error{ErrorCode::usage,
                 fmt::format("a GIF shows at most {} pictures a second, not {}: give --fps 50 or less.",
                             gif_fps_limit, fps)};
  }
  if (size.width % 2 == 0 && size.height % 2 == 0) return {};
  return Error{
      ErrorCode::usage,
      fmt::format("a video stores colour for squares of 2 x 2 pixels, so that --size {}x{} is not "
                  "possible: give an even width and height, {}x{} say.",
                  size.width, size.height, size.width + size.width % 2, size.height + size.height % 2)};
}

Result<std::unique_ptr<FrameSink>> open_video(const std::string& path, const PictureSize& size, double fps,
                                              Overwrite overwrite) {
  const auto format = video_format_of(path);
  if (!format) return format.error();
  if (const Status possible = check_video(*format, size, fps); !possible) return possible.error();
  auto file = AtomicFile::create(path, overwrite);
  if (!file) return file.error();
  if (file->temporary_path().empty())
    return Error{ErrorCode::io, fmt::format("{} is a device or a pipe, but a video needs a file.", path)};
  std::vector<std::string> words = {"ffmpeg",
                                    "-hide_banner",
                                    "-nostdin",
                                    "-loglevel",
                                    "error",
                                    "-xerror",
                                    "-y",
                                    "-f",
                                    "rawvideo",
                                    "-pixel_format",
                                    "rgb24",
                                    "-video_size",
                                    fmt::format("{}x{}", size.width, size.height),
                                    "-framerate",
                                    fmt::format("{}", fps),
                                    "-i",
                                    "pipe:0",
                                    "-an"};
  const std::vector<std::string> output = encoding(*format);
  words.insert(words.end(), output.begin(), output.end());
  words.push_back("file:" + file->temporary_path());
  auto ffmpeg = ChildProcess::start(words);
  if (!ffmpeg)
    return Error{
        ErrorCode::io,
        fmt::format("the video {} cannot be made: {} Videos need the program ffmpeg on PATH: install it with "
                    "apt install ffmpeg, or write numbered pictures instead (--frames).",
                    path, ffmpeg.error().message)};
  return std::unique_ptr<FrameSink>(std::make_unique<VideoFile>(std::move(*file), std::move(*ffmpeg)));
}

}  // namespace aspic
