#pragma once
// Shader files: embedded at build time, overridable by a directory, with includes resolved here.
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/embedded_file.h"
#include "base/result.h"

namespace aspic {

/// Every file under shaders/ by its path there, e.g. "compute/gather.comp", in the order of the paths.
std::span<const EmbeddedFile> embedded_shaders();

}  // namespace aspic

namespace aspic::gl {

/// `#define name value`.
struct Define {
  std::string name;
  std::string value;
};

/// One translation unit for the driver, and the way back from its lines to the files'.
class FlatShader {
 public:
  /// What the driver gets. It has no #line directives: Mesa forgets their file names.
  const std::string& text() const { return text_; }
  /// The path it was asked for by.
  const std::string& path() const { return files_.front(); }

  struct Origin {
    std::string_view file;  ///< "compute/gather.comp", or "defines" for the lines put in front
    int line = 0;           ///< from 1
  };
  /// Where a line of text() comes from. `line` counts from 1; one out of range belongs to "defines", line 0.
  Origin origin(int line) const;

  /// A compile log in the terms of our files: messages of Mesa, NVIDIA, AMD and Intel become
  /// `compute/gather.comp:8: error: …`, each followed by the source line and, where a column is known, a
  /// caret. Lines of other shapes stay as they are.
  std::string rewrite_log(std::string_view log) const;

 private:
  friend class ShaderLibrary;
  struct Mapped {
    int file = 0;  // -1: the lines put in front
    int line = 0;
  };

  std::string text_;
  std::vector<std::string> files_;
  std::vector<Mapped> lines_;
};

/// Where shaders come from. Copyable; holds no GL objects.
class ShaderLibrary {
 public:
  /// A file under `override_directory`, where it exists, goes before the embedded one of the same path; it is
  /// read at every request, so that shaders can be edited without rebuilding. Empty: embedded files alone.
  explicit ShaderLibrary(std::filesystem::path override_directory = {})
      : directory_(std::move(override_directory)) {}

  /// The text of one file. `path` is relative to shaders/; shapes/all.glsl is made from the table of terrain
  /// shapes. Error (io): there is none, or it cannot be read.
  Result<std::string> read(std::string_view path) const;

  /// `#version 430 core`, those of the defines that are read, and the file with every `#include "path"` put
  /// in its place, each file once. Paths are relative to shaders/. Errors (io): missing file, unreadable
  /// include line, a cycle of includes, a `#version` in a file; the sentence names file and line.
  Result<FlatShader> flatten(std::string_view path, std::span<const Define> defines = {}) const;

 private:
  struct Flattening;
  Status append(Flattening& work, const std::string& path) const;
  std::filesystem::path directory_;
};

/// The directory in the environment variable ASPIC_SHADER_DIR, whose shaders go before the embedded ones;
/// empty if it is not set. Error (io): it names no directory.
Result<std::filesystem::path> shader_directory();

}  // namespace aspic::gl
