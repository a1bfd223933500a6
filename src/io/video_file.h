#pragma once
// Videos, made by the program ffmpeg at the end of a pipe.
#include <memory>

#include "io/atomic_file.h"
#include "io/frame_sink.h"

namespace aspic {

enum class VideoFormat {
  mp4,   ///< H.264, 4:2:0, BT.709, index in front
  webm,  ///< VP9, 4:2:0, BT.709
  gif    ///< one palette for all pictures; times in hundredths of a second
};

/// The format a file name's end stands for: .mp4, .webm, .gif. Error (usage): another end.
Result<VideoFormat> video_format_of(const std::string& path);

/// Pictures per second where none are asked for: 60, in a GIF 50, the most that viewers honour.
double default_fps(VideoFormat format);

/// Whether such a video can have this size and rate. Errors (usage): an odd side where colour is stored at
/// half resolution (mp4, webm), with the nearest even size; more than 50 pictures a second in a GIF.
Status check_video(VideoFormat format, const PictureSize& size, double fps);

/// A sink that pipes pictures to ffmpeg, which writes to a temporary file beside `path`; it gets its name
/// when ffmpeg has ended well. Errors: usage (the above); io: the file exists, its place cannot be written,
/// it is no file, or ffmpeg is missing, which names the Debian package.
Result<std::unique_ptr<FrameSink>> open_video(const std::string& path, const PictureSize& size, double fps,
                                              Overwrite overwrite);

}  // namespace aspic
