#pragma once
// What the next film of the window will be.
#include <string>

#include "io/film_format.h"

namespace aspic::app {

struct FilmSettings {
  const FilmFormat* format = &film_formats().front();
  double fps = 60.0;  ///< pictures shown per second, 1 … the format's most
  bool text = true;   ///< the parameters are written on the picture
  std::string path;   ///< empty: free_name()
};

/// `path` with the ending that the format wants in place of another format's; directories have none.
std::string film_path(const std::string& path, const FilmFormat& format);

/// The ending of a film's name: that of a video, nothing for a directory.
inline std::string_view film_ending(const FilmFormat& format) {
  return format.is_directory() ? std::string_view() : format.ending;
}

}  // namespace aspic::app
