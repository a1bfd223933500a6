#pragma once
// Videos of the scene, or of all runs compared, while the user plays with it, in step with simulated time.
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/comparison_view.h"
#include "app/messages.h"
#include "app/scene_editor.h"
#include "app/scene_image.h"
#include "app/video_file.h"
#include "app/view.h"
#include "io/video_format.h"
#include "playback/playback_session.h"
#include "playback/video_pace.h"
#include "render/tiles.h"
#include "run/recording.h"

namespace aspic::app {

/// What the next video will be.
struct VideoSettings {
  const VideoFormat* format = &video_formats().front();
  double fps = 60.0;                    ///< images shown per second, 1 … the format's most
  bool text = true;                     ///< the parameters are written on the image
  std::string path;                     ///< empty: free_name()
  bool page = false;                    ///< a page for browsers is written next to it
  bool live = false;                    ///< and one that simulates there
  const StateFormat* states = nullptr;  ///< of its states next to it; null: none
};

/// The ending of a video's name: that of a video, nothing for a directory.
inline std::string_view video_ending(const VideoFormat& format) {
  return format.is_directory() ? std::string_view() : format.ending;
}

class Video {
 public:
  /// The references must outlive it.
  Video(PlaybackSession& simulation, const SceneEditor& editor, const View& view, SceneImage& image,
        Comparison& comparison, ComparisonView& comparison_view, Messages& messages)
      : simulation_(simulation),
        editor_(editor),
        view_(view),
        image_(image),
        comparison_(comparison),
        comparison_view_(comparison_view),
        messages_(messages) {}
  /// Completes the video.
  ~Video() { stop(); }

  VideoSettings settings;

  /// Videos from now on, as the settings say. A message says what went wrong.
  void start();
  /// The video is completed in the background; a message tells when.
  void stop();
  void toggle() { recording_ ? stop() : start(); }
  /// Once for each image of the window, after the run moved: takes the images that show the state, says
  /// how far the run may go (Pacer::limit), and what became of videos that ended.
  void update();
  /// The first of these alone: also where a state would be passed between two images of the window.
  void take();
  /// Before the run moves: images that were read go to the encoder. While that is behind, the motion waits
  /// and the window does not.
  void lead();
  /// The video that is made, or null.
  const Recording* recording() const { return recording_.get(); }
  /// Videos that have ended and are not complete yet.
  std::size_t completing() const { return completing_.size(); }
  /// Ends the video that is made and waits for all; a sentence about each.
  std::vector<std::string> finish();

 private:
  void end();
  void start_files();
  void keep(Result<std::unique_ptr<VideoFile>> file, std::string_view without);
  Status add_to_files();
  void end_files(bool all);
  void report_completed();
  std::uint64_t wanted_copies();
  VideoLook look_of(std::size_t run) const;
  Status draw();
  const gl::Framebuffer& drawn() const { return canvas_ ? canvas_->frame() : image_.pixels(); }

  PlaybackSession& simulation_;
  const SceneEditor& editor_;
  const View& view_;
  SceneImage& image_;
  Comparison& comparison_;
  ComparisonView& comparison_view_;
  Messages& messages_;
  std::string named_;  // settings.path when it began
  std::unique_ptr<Recording> recording_;
  std::optional<VideoPace> pace_;
  std::vector<std::unique_ptr<VideoFile>> files_;  // next to the video
  std::optional<ComparisonCanvas> canvas_;         // of several runs
  std::optional<std::uint64_t> taken_;             // step of the last image
  std::string scene_;                              // that was recorded last
  std::vector<std::unique_ptr<Recording>> completing_;
};

}  // namespace aspic::app
