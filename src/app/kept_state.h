#pragma once
// What the window remembers from one time to the next: docs/files.md, "The window's own file".
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "app/layouts.h"
#include "aspic/scene.h"
#include "base/result.h"
#include "io/video_format.h"
#include "playback/pacer.h"

namespace aspic::app {

/// Place of the window on the desktop [screen units].
struct WindowPlace {
  int width = 0, height = 0;
  std::optional<std::array<int, 2>> position;
  friend bool operator==(const WindowPlace&, const WindowPlace&) = default;
};

/// Where a scene was last seen from.
struct KeptCamera {
  std::string scene;  ///< built-in name or absolute path
  CameraSettings camera;
  friend bool operator==(const KeptCamera&, const KeptCamera&) = default;
};

struct KeptState {
  std::optional<WindowPlace> window;
  Layouts layout;
  Pace pace = Pace::real_time;
  double speed = 1.0;
  const VideoFormat* video_format = &video_formats().front();
  double video_fps = 60.0;
  bool video_text = false;
  bool greeted = false;             ///< what the keys are was said
  std::vector<KeptCamera> cameras;  ///< the one last used at the end
  friend bool operator==(const KeptState&, const KeptState&) = default;
};

/// Scenes whose cameras are kept; the one longest unused goes first.
inline constexpr std::size_t most_kept_cameras = 12;
/// Puts a scene's camera at the end; without one it is removed.
void keep_camera(std::vector<KeptCamera>& cameras, const std::string& scene,
                 const std::optional<CameraSettings>& camera);
/// The name that a scene's camera is kept under: built-in scenes by name, files by absolute path.
std::string camera_key(const std::string& source);

/// As the file holds it, and back. Error (io): the text is broken, of another version, or holds what the
/// window would not have written; the sentence names the first such thing.
std::string to_text(const KeptState& state);
Result<KeptState> read_kept_state(const std::string& text);

/// $XDG_STATE_HOME/aspic/window.json, or below ~/.local/state; empty where neither is known.
std::string kept_state_path();
/// Reads the file. One that is not there is no error and gives what a first time gives. Error (io): the file
/// cannot be used, or there is only the window.toml of version 1.
Result<KeptState> load_kept_state(const std::string& path);
/// Writes the file and makes the directories above it; removes that of version 1. Error (io).
Status save_kept_state(const KeptState& state, const std::string& path);

}  // namespace aspic::app
