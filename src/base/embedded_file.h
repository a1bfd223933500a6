#pragma once
// Files that are compiled into the program, see cmake/EmbedFiles.cmake.
#include <optional>
#include <span>
#include <string_view>

namespace aspic {

struct EmbeddedFile {
  std::string_view name;  ///< path relative to the base directory that was named when embedding
  std::string_view text;  ///< its bytes
};

/// The content of the file of that name, if there is one.
inline std::optional<std::string_view> find_embedded(std::span<const EmbeddedFile> files,
                                                     std::string_view name) {
  for (const EmbeddedFile& file : files) {
    if (file.name == name) return file.text;
  }
  return std::nullopt;
}

}  // namespace aspic
