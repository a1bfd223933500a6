#include "app/film_format.h"

#include <algorithm>
#include <iterator>

#include "io/video_file.h"

namespace aspic::app {

std::string_view name_of(FilmFormat format) {
  switch (format) {
    case FilmFormat::mp4:
      return "mp4";
    case FilmFormat::webm:
      return "webm";
    case FilmFormat::gif:
      return "gif";
    case FilmFormat::png:
      return "png";
    case FilmFormat::jpeg:
      return "jpeg";
  }
  return "";
}

std::optional<FilmFormat> film_format_of(std::string_view name) {
  const auto found =
      std::ranges::find_if(film_formats, [&](FilmFormat format) { return name_of(format) == name; });
  return found == std::end(film_formats) ? std::nullopt : std::optional(*found);
}

bool is_directory(FilmFormat format) {
  return format == FilmFormat::png || format == FilmFormat::jpeg;
}

double most_fps(FilmFormat format) {
  return format == FilmFormat::gif ? default_fps(VideoFormat::gif) : 240.0;
}

}  // namespace aspic::app
