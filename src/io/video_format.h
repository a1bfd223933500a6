#pragma once
// The table of video formats: everything that any program asks of one is in its row.
#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "aspic/files.h"
#include "io/atomic_file.h"

namespace aspic {

/// What images become: a video that ffmpeg encodes, or a directory of numbered images.
struct VideoFormat {
  std::string_view name;    ///< word of options and of files: "mp4"
  std::string_view label;   ///< for people: "MP4 (H.264)"
  std::string_view ending;  ///< of the video's file or of each image, in lower case: ".mp4"
  double default_fps = 60.0, most_fps = 1000.0;  ///< images shown per second
  bool even_sides = false;              ///< 4:2:0, BT.709: color is stored for squares of 2 × 2 pixels
  std::span<const char* const> ffmpeg;  ///< ffmpeg's options for the output; empty: no video
  /// One image (FrameSink::write) as the content of a file; null for videos. Error (io): the encoder
  /// failed.
  Result<std::string> (*encode)(const ImageSize& size, std::span<const std::byte> rgb) = nullptr;
  std::size_t mark_at = 0;     ///< where the video's mark begins [bytes]
  std::string_view mark = {};  ///< what every video of the format has there

  bool is_directory() const { return encode != nullptr; }
};

/// All formats, videos first; the first is the default.
std::span<const VideoFormat> video_formats() noexcept;

/// The video format that the ending of a file name says. Error (usage): no such ending.
Result<const VideoFormat*> video_format_of(const std::string& path);

/// Words of all image formats (directories) or of all videos as their endings: "png or jpg".
std::string video_endings(bool directories);

/// Whether a video can have this size and rate. Errors (usage): an odd side where the format needs even ones,
/// with the nearest even size; more images a second than the format shows.
Status check_video(const VideoFormat& format, const ImageSize& size, double fps);

/// Opens a sink: open_video_file() or open_frame_directory(). Errors: those of check_video() and of the two.
Result<std::unique_ptr<FrameSink>> open_video(const VideoFormat& format, const std::string& path,
                                              const ImageSize& size, double fps, Overwrite overwrite);

/// One image as the content of a file. JPEG keeps colors at every pixel. Error (io): the encoder failed.
Result<std::string> encode_png(const ImageSize& size, std::span<const std::byte> rgb);
/// The same with a share of coverage behind each color: height·width·4 bytes.
Result<std::string> encode_clear_png(const ImageSize& size, std::span<const std::byte> rgba);
Result<std::string> encode_jpeg(const ImageSize& size, std::span<const std::byte> rgb);

/// A sink of files frame-000000.png, … in `directory`, which is made if its parent exists. Every file appears
/// complete or not at all. Errors (io): the directory cannot be made or written to; it has frame-… images
/// already and `overwrite` is refuse. With allow, those are removed once the first new one is there: a video
/// that never begins costs nothing, and images of two runs are never taken for one.
Result<std::unique_ptr<FrameSink>> open_frame_directory(const std::string& directory,
                                                        const VideoFormat& format, const ImageSize& size,
                                                        Overwrite overwrite);

/// A sink that pipes images to ffmpeg, which writes to a temporary file next to `path`; it gets its name
/// when ffmpeg has ended well, has read every image, and left a file that has the format's mark and that
/// ffprobe, where it is installed, does not refuse. The format is a video's. Errors (io): the file exists,
/// its place cannot be written, it is no file, or ffmpeg is missing, which names the Debian package.
Result<std::unique_ptr<FrameSink>> open_video_file(const std::string& path, const VideoFormat& format,
                                                   const ImageSize& size, double fps, Overwrite overwrite);

}  // namespace aspic
