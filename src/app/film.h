#pragma once
// Films of the scene, or of all runs compared, while the user plays with it, in step with simulated time.
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/comparison_view.h"
#include "app/film_file.h"
#include "app/messages.h"
#include "app/scene_editor.h"
#include "app/scene_picture.h"
#include "app/view.h"
#include "io/film_format.h"
#include "playback/film_pace.h"
#include "playback/playback_session.h"
#include "render/tiles.h"
#include "run/recording.h"

namespace aspic::app {

/// What the next film will be.
struct FilmSettings {
  const FilmFormat* format = &film_formats().front();
  double fps = 60.0;                    ///< pictures shown per second, 1 … the format's most
  bool text = true;                     ///< the parameters are written on the picture
  std::string path;                     ///< empty: free_name()
  bool page = false;                    ///< a page for browsers is written next to it
  bool live = false;                    ///< and one that simulates there
  const StateFormat* states = nullptr;  ///< of its states next to it; null: none
};

/// The ending of a film's name: that of a video, nothing for a directory.
inline std::string_view film_ending(const FilmFormat& format) {
  return format.is_directory() ? std::string_view() : format.ending;
}

class Film {
 public:
  /// The references must outlive it.
  Film(PlaybackSession& simulation, const SceneEditor& editor, const View& view, ScenePicture& picture,
       Comparison& comparison, ComparisonView& comparison_view, Messages& messages)
      : simulation_(simulation),
        editor_(editor),
        view_(view),
        picture_(picture),
        comparison_(comparison),
        comparison_view_(comparison_view),
        messages_(messages) {}
  /// Completes the film.
  ~Film() { stop(); }

  FilmSettings settings;

  /// Films from now on, as the settings say. A message says what went wrong.
  void start();
  /// The film is completed in the background; a message tells when.
  void stop();
  void toggle() { recording_ ? stop() : start(); }
  /// Once for each picture of the window, after the run moved: takes the pictures that show the state, says
  /// how far the run may go (Pacer::limit), and what became of films that ended.
  void update();
  /// The first of these alone: also where a state would be passed between two pictures of the window.
  void take();
  /// Before the run moves: pictures that were read go to the encoder. While that is behind, the motion waits
  /// and the window does not.
  void lead();
  /// The film that is made, or null.
  const Recording* recording() const { return recording_.get(); }
  /// Films that have ended and are not complete yet.
  std::size_t completing() const { return completing_.size(); }
  /// Ends the film that is made and waits for all; a sentence about each.
  std::vector<std::string> finish();

 private:
  void end();
  void start_files();
  void keep(Result<std::unique_ptr<FilmFile>> file, std::string_view without);
  Status add_to_files();
  void end_files(bool all);
  void report_completed();
  std::uint64_t wanted_copies();
  FilmLook look_of(std::size_t run) const;
  Status draw();
  const gl::Framebuffer& drawn() const { return canvas_ ? canvas_->frame() : picture_.pixels(); }

  PlaybackSession& simulation_;
  const SceneEditor& editor_;
  const View& view_;
  ScenePicture& picture_;
  Comparison& comparison_;
  ComparisonView& comparison_view_;
  Messages& messages_;
  std::string named_;  // settings.path when it began
  std::unique_ptr<Recording> recording_;
  std::optional<FilmPace> pace_;
  std::vector<std::unique_ptr<FilmFile>> files_;  // next to the film
  std::optional<ComparisonCanvas> canvas_;        // of several runs
  std::optional<std::uint64_t> taken_;            // step of the last picture
  std::string scene_;                             // that was filmed last
  std::vector<std::unique_ptr<Recording>> completing_;
};

}  // namespace aspic::app
