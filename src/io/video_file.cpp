#include <fmt/format.h>

#include <chrono>
#include <optional>

#include "base/files.h"
#include "io/child_process.h"
#include "io/video_format.h"

namespace aspic {
namespace {

/// ffmpeg's options up to the size of the images it reads.
constexpr const char* raw_input[] = {"ffmpeg",   "-hide_banner",  "-nostdin", "-loglevel",
                                     "error",    "-xerror",       "-y",       "-f",
                                     "rawvideo", "-pixel_format", "rgb24",    "-video_size"};

std::string message_of(const ChildProcess& program, std::size_t lines) {
  const std::string said = program.last_lines(lines);
  return said.empty() ? " without a message. " : fmt::format(" and said\n{}", said);
}

/// What became of an ffmpeg that did not do its work; a sentence.
std::string failure_text(const ChildProcess& ffmpeg, const ChildProcess::End& end) {
  if (end.stalled) return "ffmpeg stopped responding and was ended. ";
  const std::string how = end.signal != 0      ? fmt::format("was ended by signal {}", end.signal)
                          : end.exit_code != 0 ? fmt::format("ended with exit code {}", end.exit_code)
                                               : "ended before it had read all frames";
  return fmt::format("ffmpeg {}{}", how, message_of(ffmpeg, 6));
}

/// What is wrong with a video, as far as its beginning and ffprobe tell: a sentence, or nothing.
std::string fault_of(const std::string& file, const VideoFormat& format) {
  const auto start = read_regular_file(file, format.mark_at + format.mark.size());
  if (!start) return start.error().what + " ";
  if (start->size == 0) return "ffmpeg reported success, but wrote an empty file. ";
  if (start->content.size() < format.mark_at || start->content.substr(format.mark_at) != format.mark)
    return fmt::format("ffmpeg reported success, but its output is not a {} file. ", format.label);
  auto probe = ChildProcess::start(
      {"ffprobe", "-v", "error", "-show_entries", "stream=codec_type", "-i", "file:" + file});
  if (!probe) return "";
  const ChildProcess::End end = probe->finish(std::chrono::seconds(20));
  if (end.exit_code != 1) return "";  // well, or ffprobe itself is broken, which tells nothing of the video
  return "ffmpeg reported success, but ffprobe rejects the video" + message_of(*probe, 3);
}

class VideoFile : public FrameSink {
 public:
  VideoFile(AtomicFile file, ChildProcess ffmpeg, const VideoFormat& format)
      : file_(std::move(file)), ffmpeg_(std::move(ffmpeg)), format_(format), path_(file_->path()) {}

  Status write(std::span<const std::byte> rgb) override {
    if (ffmpeg_ && !ffmpeg_->write(rgb)) give_up(failure_text(*ffmpeg_, ffmpeg_->finish()));
    return state();
  }

  Status finish() override {
    if (!ffmpeg_) return state();
    const ChildProcess::End end = ffmpeg_->finish();
    const std::string fault =
        end.ok() ? fault_of(file_->temporary_path(), format_) : failure_text(*ffmpeg_, end);
    if (fault.empty()) return file_->commit();
    give_up(fault);
    return state();
  }

  const std::string& path() const override { return path_; }

 private:
  /// Leaves nothing.
  void give_up(const std::string& why) {
    reason_ =
        advised(fail(ErrorCode::io, "cannot make the video {}: {}", path_, why),
                {advice("check the disk, and that ffmpeg has the encoder (the Debian package ffmpeg has it)"),
                 {RemedyKind::write_images}});
    ffmpeg_.reset();
    file_.reset();  // removes the temporary file
  }
  Status state() const { return ffmpeg_ ? Status() : Status(reason_); }

  std::optional<AtomicFile> file_;
  std::optional<ChildProcess> ffmpeg_;
  const VideoFormat& format_;
  std::string path_;
  Error reason_ = {ErrorCode::io, ""};  // why there is no ffmpeg_
};

}  // namespace

Result<std::unique_ptr<FrameSink>> open_video_file(const std::string& path, const VideoFormat& format,
                                                   const ImageSize& size, double fps, Overwrite overwrite) {
  ASPIC_TRY(auto file, AtomicFile::create(path, overwrite));
  if (file.temporary_path().empty())
    return fail(ErrorCode::io, "{} is a device or a pipe, but a video needs a file.", path);
  std::vector<std::string> words(std::begin(raw_input), std::end(raw_input));
  words.insert(words.end(), {fmt::format("{}x{}", size.width, size.height), "-framerate",
                             fmt::format("{}", fps), "-i", "pipe:0", "-an"});
  if (format.even_sides) {
    // sRGB in, BT.709 video range out. New versions of ffmpeg take primaries and transfer from the images.
    words.insert(words.end(), {"-vf",
                               "scale=out_color_matrix=bt709:out_range=tv:flags=accurate_rnd,format=yuv420p,"
                               "setparams=color_primaries=bt709:color_trc=iec61966-2-1",
                               "-colorspace", "bt709", "-color_primaries", "bt709", "-color_trc",
                               "iec61966-2-1", "-color_range", "tv"});
  }
  words.insert(words.end(), format.ffmpeg.begin(), format.ffmpeg.end());
  words.push_back("file:" + file.temporary_path());
  auto ffmpeg = ChildProcess::start(words);
  if (!ffmpeg)
    return advised(
        fail(ffmpeg.error(), "cannot make the video {}: {} Videos need the program ffmpeg on PATH.", path,
             ffmpeg.error().what),
        {advice("install it with apt install ffmpeg"), {RemedyKind::write_images}});
  return std::unique_ptr<FrameSink>(std::make_unique<VideoFile>(std::move(file), std::move(*ffmpeg), format));
}

}  // namespace aspic
