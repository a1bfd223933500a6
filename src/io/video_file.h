#pragma once
// Videos, made by the program ffmpeg at the end of a pipe.
#include <memory>

#include "io/film_format.h"

namespace aspic {

/// A sink that pipes pictures to ffmpeg, which writes to a temporary file next to `path`; it gets its name
/// when ffmpeg has ended well. The format is a video's. Errors (io): the file exists, its place cannot be
/// written, it is no file, or ffmpeg is missing, which names the Debian package.
Result<std::unique_ptr<FrameSink>> open_video(const std::string& path, const FilmFormat& format,
                                              const PictureSize& size, double fps, Overwrite overwrite);

}  // namespace aspic
