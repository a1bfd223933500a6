#pragma once
// Runs side by side: the window's own and others of the same scene, each with one difference, on one clock.
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/companion.h"
#include "app/gui.h"
#include "app/messages.h"
#include "app/scene_control.h"
#include "app/scene_picture.h"
#include "app/view.h"
#include "app/window.h"
#include "base/result.h"
#include "playback/simulation.h"
#include "render/colour_map.h"
#include "run/beside.h"

namespace aspic::app {

/// The pictures of all runs change together, once each has come to the clock's time; the window's own run
/// waits for the others. What runs there are is the editor's: see SceneEditor::beside().
class Beside {
 public:
  /// The references must outlive it.
  Beside(Simulation& leader, SceneControl& scene, View& view, ScenePicture& picture, Messages& messages,
         const BackendChoice& asked)
      : leader_(leader), scene_(scene), view_(view), picture_(picture), messages_(messages), asked_(asked) {}

  /// Everything of OpenGL and of backends, in a context that must outlive it or be detached.
  void attach(gl::Context& context) { context_ = &context; }
  void detach();

  /// What the plots of all runs show, of each kind of plot: see energy_section().
  std::array<std::size_t, 2> compared = {3, 3};

  bool active() const { return !companions_.empty(); }
  /// Runs in all, the window's own included.
  std::size_t count() const { return companions_.size() + 1; }
  const Simulation& run(std::size_t i) const { return i == 0 ? leader_ : companions_[i - 1]->simulation(); }
  const Scene& scene(std::size_t i) const { return i == 0 ? scene_.scene() : companions_[i - 1]->scene(); }
  ScenePicture& picture(std::size_t i) { return i == 0 ? picture_ : companions_[i - 1]->picture(); }
  /// What distinguishes a run from the others, in few words: of the window's own run all values that others
  /// differ in, of those their own difference.
  std::string name(std::size_t i) const;
  /// The colour of a run's curves and label, as ImGui packs it.
  static std::uint32_t packed_colour(std::size_t i);

  /// One more run, with a difference that suggests itself; nothing if there are most_beside already.
  void add();
  /// Another difference of run i ≥ 1. A message says why one is refused; then nothing changes.
  void set(std::size_t i, const Variation& variation);
  void remove(std::size_t i);
  /// Back to one run.
  void leave();

  /// The window's own run diverged and others continue.
  bool others_go_on() const { return leader_.divergence() && stand_in() != nullptr; }
  /// Starts or pauses those that continue. False if the window's own run is the one to start.
  bool toggle();
  bool running() const { return others_run_; }
  /// A run other than the window's own has something to take up.
  bool busy() const;

  // ---- the clock of all ----
  /// The run that sets it: the window's own, or after its divergence the first that continues.
  const Simulation& clock() const { return others_go_on() ? stand_in()->simulation() : leader_; }
  bool clock_runs() const { return leader_.running() || others_run_; }
  /// The time that the pictures show [s].
  double clock_time() const;
  /// All pictures show the very step that the run of the clock is at.
  bool shows_clock() const;
  /// Pacer::limit() of the clock's run, and of no other.
  void limit(Hold source, std::optional<std::uint64_t> step);
  /// The last time that there is to go to [s]: of the run that came furthest, while they move what is shown.
  double end_time() const;
  /// To the moment nearest to a time [s]; false if the window's own run has it: that goes then, and the
  /// others follow.
  bool go_to(double time);
  /// Simulated seconds per second of the pictures; 0 before there is a measurement.
  double real_time_factor() const { return several() ? factor_ : aspic::real_time_factor(leader_); }
  /// The newest time, up to that of the pictures, at which all runs but those that diverged have energies
  /// [s].
  double figures_time() const;
  /// Why hands that touch particles cannot act on all runs; nothing: they can.
  std::optional<std::string> hands_refused() const;

  // ---- the ghost: an earlier run in the picture of the window's own ----
  /// The run so far is the ghost from now on, instead of another one.
  void keep_ghost();
  void remove_ghost();
  /// The ghost's run; null if there is none.
  const Simulation* ghost() const { return ghost_ ? ghost_->simulation.get() : nullptr; }
  /// The last time that the ghost has come to [s]; there is a ghost.
  double ghost_end() const;

  /// More than the window's own run is shown.
  bool several() const { return active() || ghost_; }
  /// Before and after the window's own run moves.
  void lead();
  Status follow(double dt, double budget);
  /// All runs have come to one time, which is shown.
  bool settled() const { return settled_; }
  /// The time that the picture of a run shows [s], and its divergence if it diverged on the way there.
  double shown_time(std::size_t i) const { return i < shown_.size() ? shown_[i].time : run(i).time(); }
  std::optional<Divergence> shown_divergence(std::size_t i) const {
    return i < shown_.size() ? shown_[i].divergence : std::nullopt;
  }
  /// Divides the place of the scene between the runs; returns that of the window's own.
  void place(const Box& whole);
  /// The places of all runs [window units]; one if there is only the window's own.
  const std::vector<Box>& boxes() const { return boxes_; }
  /// Before pictures are drawn: those of one colour and scale get the widest of their ranges, so that colours
  /// can be compared.
  void share_colours();
  /// Draws the other runs' pictures, after ScenePicture::show() did the window's own.
  Status show(const WindowSize& window);
  /// Of one of them a fine picture is under way.
  bool refining() const;
  /// Names the runs on their pictures, between Gui::begin and end.
  void draw_labels(const Gui& gui) const;

 private:
  void draw_ghost_label(const Gui& gui) const;
  /// An earlier run, which its history makes again.
  struct Ghost {
    Scene scene;
    std::unique_ptr<Simulation> simulation;
    std::unique_ptr<ScenePicture> picture;
    std::string source;  ///< of the scene
    bool arrived = false;
    std::uint64_t shown = 0;  ///< number of the picture that is kept
  };
  Status follow_with_ghost(double time, double dt, double budget);
  Companion* stand_in() const;
  Status recall(double time, double dt, double budget);
  void measure_factor(double dt);
  void match_editor();
  void end_waiting();
  void keep_shown();

  Simulation& leader_;
  SceneControl& scene_;
  View& view_;
  ScenePicture& picture_;
  Messages& messages_;
  BackendChoice asked_;
  gl::Context* context_ = nullptr;
  std::vector<std::unique_ptr<Companion>> companions_;
  std::unique_ptr<Ghost> ghost_;
  std::vector<Box> boxes_;
  bool settled_ = true, others_run_ = false, was_running_ = false;
  std::optional<double> recalled_;  // a time after the window's own run diverged that is shown
  double factor_ = 0.0, measured_for_ = 0.0, measured_from_ = 0.0;  // real_time_factor() [1], [s], [s]
  /// What is kept of a run.
  struct Shown {
    std::uint64_t picture = 0;
    double time = 0.0;
    std::optional<Divergence> divergence;
  };
  std::vector<Shown> shown_;  // of each run
};

}  // namespace aspic::app
