#pragma once
// The pictures of a run from its states to its files: drawn here, or in several processes at once.
#include <cstdint>
#include <deque>
#include <memory>
#include <string>
#include <vector>

#include "base/result.h"
#include "run/drawers.h"
#include "run/picture_painter.h"
#include "run/recording.h"
#include "run/run_files.h"

namespace aspic {

/// A run's state on its way into a picture.
struct PaintedState {
  Solver* solver = nullptr;  ///< that is at the state
  DeviceState there = {};    ///< where the state lies on the device; without particles: in memory
};

/// Draws pictures and hands them to a recording, in their order. On a software rasteriser processes draw them
/// (run/drawers.h), where `output` names a program for it; every byte is the same.
class FilmPainter {
 public:
  /// `pictures`: in all, as planned. The context, and what the runs refer to, must outlive it. Errors: those
  /// of PicturePainter::create(), Recording::start() and drawers_for().
  static Result<std::unique_ptr<FilmPainter>> create(gl::Context& context, const PictureOutput& output,
                                                     std::vector<PaintedRun> runs, std::uint64_t pictures,
                                                     std::vector<std::unique_ptr<FrameSink>> sinks);
  ~FilmPainter();
  FilmPainter(const FilmPainter&) = delete;
  FilmPainter& operator=(const FilmPainter&) = delete;

  /// Adds a picture of the runs' states, `copies` ≥ 1 times; they may change afterwards. Errors: those of
  /// drawing; once all outputs are lost, the encoder's.
  Status add(const std::vector<PaintedState>& states, std::vector<ShownRun> shown, std::uint64_t copies);
  /// All pictures are added: completes the outputs. Errors as add().
  Status finish();
  /// Ends without films; pictures in directories stay.
  void abandon();

  Recording& recording() { return *recording_; }
  const Recording& recording() const { return *recording_; }
  /// With the time spent on drawing and reading back, in whichever process.
  FrameTimes times() const;
  /// GL_RENDERER of the device that draws.
  const std::string& device() const { return context_->info().renderer; }

 private:
  /// A picture that a process was asked for.
  struct Asked {
    Drawers::Place place;
    DrawerRequest request;
    std::uint64_t copies = 1;
  };
  FilmPainter(gl::Context& context, PictureOutput output, std::vector<PaintedRun> runs)
      : context_(&context), output_(std::move(output)), runs_(std::move(runs)) {}
  Result<PicturePainter*> painter();
  Result<DeviceState> uploaded(std::size_t run, const PaintedState& state);
  Status turn_balls(const std::vector<PaintedState>& states, std::vector<ShownRun>& shown);
  Result<bool> ask(const std::vector<PaintedState>& states, std::vector<ShownRun>& shown,
                   std::uint64_t copies);
  Status take_first();
  Status draw_first_here();
  Status draw_here(const std::vector<DeviceState>& states, const std::vector<ShownRun>& shown,
                   std::uint64_t copies);

  gl::Context* context_;
  PictureOutput output_;
  std::vector<PaintedRun> runs_;
  double draw_seconds_ = 0.0, read_seconds_ = 0.0;
  unsigned processes_ = 0;
  std::unique_ptr<PicturePainter> painter_;  // made when it is first needed
  std::unique_ptr<Drawers> drawers_;
  std::vector<TurnedBalls> turned_;       // of each run, as of the last picture, where processes draw
  std::deque<Asked> asked_;               // in the pictures' order
  std::unique_ptr<Recording> recording_;  // last: its thread reads what processes have drawn
};

}  // namespace aspic
