#pragma once
// The kinds of film that the window writes.
#include <optional>
#include <string_view>

namespace aspic::app {

/// What a film is written as: one file, or a directory of numbered pictures.
enum class FilmFormat { mp4, webm, gif, png, jpeg };
inline constexpr FilmFormat film_formats[] = {FilmFormat::mp4, FilmFormat::webm, FilmFormat::gif,
                                              FilmFormat::png, FilmFormat::jpeg};

/// As people and state files call it: "mp4".
std::string_view name_of(FilmFormat format);
std::optional<FilmFormat> film_format_of(std::string_view name);
/// Whether the pictures go into a directory.
bool is_directory(FilmFormat format);
/// The most pictures per second that viewers of the format show.
double most_fps(FilmFormat format);

}  // namespace aspic::app
