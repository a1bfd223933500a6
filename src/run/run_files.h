#pragma once
// What a run writes: its outputs as plain data, and the files that hold them.
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/result.h"
#include "io/film_format.h"
#include "io/state_sink.h"

namespace aspic {

/// A file of states.
struct StateOutput {
  std::string option;                  ///< one of state_options()
  std::string path;                    ///< empty: none
  std::optional<std::uint64_t> every;  ///< steps, ≥ 1; absent: what the format has
};

/// Pictures of a run.
struct PictureOutput {
  std::string video, frames;  ///< file and directory; empty: none
  const FilmFormat* frames_format = find_film_format("png");
  std::optional<double> fps;  ///< pictures per second shown, > 0; absent: what the formats have
  double speed = 1.0;         ///< simulated seconds per second shown, > 0
  PictureSize size;
  bool text = true;  ///< parameters and time are written on them
  /// A program that calls serve_pictures() (run/drawer.h) and its words, to draw on software rasterisers with
  /// all processors; empty: this one draws alone.
  std::vector<std::string> drawer = {};

  bool any() const { return !video.empty() || !frames.empty(); }
};

/// Whether the names of all outputs say formats that these options have. Error (usage).
Status check_endings(const std::vector<StateOutput>& outputs);

/// The pictures per second that were asked for, or what the formats have where nothing was.
double frames_per_second(const PictureOutput& output);

/// A name in the working directory that nothing has yet: `aspic-cube-plane-0001.mp4`. `scene` is a file or a
/// built-in name; the ending may be empty.
std::string free_name(const std::string& scene, std::string_view ending);

/// The files of a run: opened before it, completed after it. One that fails on the way does not keep the
/// others from being written.
class RunFiles {
 public:
  /// Opens every file that is named. Errors: usage for one name given twice; io; interrupted.
  static Result<RunFiles> open(const std::vector<StateOutput>& states, const PictureOutput& pictures,
                               const RunFacts& facts, Overwrite overwrite);

  /// The first step after `step` at which a file wants the state; the largest number if none does.
  std::uint64_t next_step(std::uint64_t step) const;
  /// Hands a state to the files that want it: the first of the run, and those of next_step(). Errors: a file
  /// refused the first state; a number is not finite. Later failures are those of failures().
  Status take(const Sample& sample);
  /// Completes all files with the last state. One that fails does not keep the others from being completed.
  /// Error: the first of failures().
  Status finish(const Sample& last);
  /// The first failure of each file so far. States in files of their own are tried again the next time.
  const std::vector<Error>& failures() const { return failures_; }
  /// Whether the run writes anything besides pictures that is not lost.
  bool any_left() const;

  /// Hands over the sinks of the pictures.
  std::vector<std::unique_ptr<FrameSink>> take_frame_sinks() { return std::move(frame_sinks_); }
  /// Names of the completed files.
  const std::vector<std::string>& written() const { return written_; }

 private:
  struct Output {
    std::unique_ptr<StateSink> sink;
    bool failed = false;
  };
  RunFiles() = default;
  void note_failure(Output& output, const Error& error);

  std::vector<Output> outputs_;
  std::vector<std::unique_ptr<FrameSink>> frame_sinks_;
  std::vector<std::string> written_;
  std::vector<Error> failures_;
  bool begun_ = false;
};

}  // namespace aspic
