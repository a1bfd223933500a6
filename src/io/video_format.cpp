#include "io/video_format.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <vector>

namespace aspic {
namespace {

constexpr double gif_fps = 50.0;  // the shortest image that viewers honor: two hundredths of a second

// The index goes in front. Of drawn images, medium at 18 makes as large a file in twice the time, and is
// less than a decibel nearer to them.
constexpr const char* mp4[] = {"-c:v", "libx264",   "-preset",    "veryfast", "-crf",
                               "16",   "-movflags", "+faststart", "-f",       "mp4"};
constexpr const char* webm[] = {"-c:v", "libvpx-vp9", "-crf", "28",      "-b:v", "0",  "-deadline",
                                "good", "-cpu-used",  "4",    "-row-mt", "1",    "-f", "webm"};
// One palette for all images.
constexpr const char* gif[] = {
    "-vf",   "split[a][b];[a]palettegen=stats_mode=full[p];[b][p]paletteuse=dither=sierra2_4a",
    "-loop", "0",
    "-f",    "gif"};

constexpr VideoFormat table[] = {
    {"mp4", "MP4 (H.264)", ".mp4", 60.0, 1000.0, true, mp4, nullptr, 4, "ftyp"},
    {"webm", "WebM (VP9)", ".webm", 60.0, 1000.0, true, webm, nullptr, 0, "\x1a\x45\xdf\xa3"},
    {"gif", "GIF", ".gif", gif_fps, gif_fps, false, gif, nullptr, 0, "GIF8"},
    {"png", "PNG frames", ".png", 60.0, 1000.0, false, {}, encode_png},
    {"jpeg", "JPEG frames", ".jpg", 60.0, 1000.0, false, {}, encode_jpeg},
};

}  // namespace

FrameSink::~FrameSink() = default;

std::span<const VideoFormat> video_formats() noexcept {
  return table;
}

const VideoFormat* find_video_format(std::string_view word) {
  std::string name(word.starts_with('.') ? word.substr(1) : word);
  std::ranges::transform(name, name.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  const auto* const found = std::ranges::find_if(
      table, [&](const VideoFormat& f) { return f.name == name || f.ending.substr(1) == name; });
  return found == std::end(table) ? nullptr : found;
}

std::string video_endings(bool directories) {
  std::vector<std::string_view> endings;
  for (const VideoFormat& format : table)
    if (format.is_directory() == directories) endings.push_back(format.ending.substr(directories ? 1 : 0));
  const std::string_view last = endings.back();
  endings.pop_back();
  return fmt::format("{} or {}", fmt::join(endings, ", "), last);
}

Result<const VideoFormat*> video_format_of(const std::string& path) {
  const std::size_t dot = path.rfind('.');
  const VideoFormat* const format =
      dot == std::string::npos ? nullptr : find_video_format(std::string_view(path).substr(dot));
  if (format && !format->is_directory()) return format;
  return fail(ErrorCode::usage, "the video's name {} must end in {}, which sets its format.", path,
              video_endings(false));
}

Status check_video(const VideoFormat& format, const ImageSize& size, double fps) {
  if (fps > format.most_fps) {
    return advised(fail(ErrorCode::usage, "{} shows at most {} frames per second, not {}.", format.label,
                        format.most_fps, fps),
                   {{RemedyKind::lower_fps, {fmt::format("{}", format.most_fps)}}});
  }
  if (!format.even_sides || (size.width % 2 == 0 && size.height % 2 == 0)) return {};
  return advised(
      fail(ErrorCode::usage,
           "a video stores color for squares of 2 x 2 pixels: choose an even width and height, not {}x{}.",
           size.width, size.height),
      {{RemedyKind::image_size,
        {fmt::format("{}", size.width + size.width % 2), fmt::format("{}", size.height + size.height % 2)}}});
}

Result<std::unique_ptr<FrameSink>> open_video(const VideoFormat& format, const std::string& path,
                                              const ImageSize& size, double fps, Overwrite overwrite) {
  ASPIC_CHECK(check_video(format, size, fps));
  return format.is_directory() ? open_frame_directory(path, format, size, overwrite)
                               : open_video_file(path, format, size, fps, overwrite);
}

}  // namespace aspic
