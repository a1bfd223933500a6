#pragma once
// A directory of numbered pictures.
#include <memory>

#include "io/film_format.h"

namespace aspic {

/// One picture as the content of a file. JPEG has quality 92. Error (io): the encoder gave nothing.
Result<std::string> encode_png(const PictureSize& size, std::span<const std::byte> rgb);
Result<std::string> encode_jpeg(const PictureSize& size, std::span<const std::byte> rgb);

/// A sink of files frame-000000.png, … in `directory`, which is made if its parent exists. Every file appears
/// complete or not at all. Errors (io): the directory cannot be made or written to; it has frame-… pictures
/// already and `overwrite` is refuse. With allow, those are removed first, so that pictures of two runs never
/// exist side by side.
Result<std::unique_ptr<FrameSink>> open_frame_directory(const std::string& directory,
                                                        const FilmFormat& format, const PictureSize& size,
                                                        Overwrite overwrite);

}  // namespace aspic
