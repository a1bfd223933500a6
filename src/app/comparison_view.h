#pragma once
// What the window shows of runs compared: their images side by side, their names and colors; and what it
// offers to compare.
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "app/gui.h"
#include "app/messages.h"
#include "app/scene_control.h"
#include "app/scene_image.h"
#include "app/view.h"
#include "app/window.h"
#include "base/result.h"
#include "playback/comparison.h"

namespace aspic::app {

/// What differences there are is the editor's: see SceneEditor::differences().
class ComparisonView {
 public:
  /// The references must outlive it. `image` is that of run 0.
  ComparisonView(Comparison& comparison, SceneControl& scene, View& view, SceneImage& image,
                 Messages& messages, const BackendChoice& asked)
      : comparison_(comparison),
        scene_(scene),
        view_(view),
        image_(image),
        messages_(messages),
        asked_(asked) {}

  /// Everything of OpenGL and of backends, in a context that must outlive it or be detached.
  void attach(gl::Context& context) { context_ = &context; }
  void detach();

  const Comparison& comparison() const { return comparison_; }

  /// What the plots of all runs show, of each kind of plot: see energy_section().
  std::array<std::size_t, 2> compared = {3, 3};

  // ---- what is compared ----
  /// One more run, with a difference that suggests itself; refused if there are most_compared already.
  void add();
  /// Another difference of run i ≥ 1. A message says why one is refused; then nothing changes.
  void set(std::size_t i, const Difference& difference);
  void remove(std::size_t i);
  /// Back to one run.
  void leave();
  /// The run so far is the ghost from now on, pale over the image of run 0, instead of another one.
  void keep_ghost();
  void remove_ghost();
  /// The ghost as it is drawn; null: there is none.
  const SceneImage* ghost() const { return ghost_.get(); }
  /// Before the runs move: there are those that the editor has, and the ghost is of its scene.
  void match_editor();
  /// ComparisonClock::go_to(), with the scene's values of that time.
  bool go_to(double time);

  // ---- images ----
  SceneImage& image(std::size_t i) { return i == 0 ? image_ : *images_[i - 1].image; }
  /// What distinguishes a run from the others, in few words: of run 0 all values that others differ in, of
  /// those their own difference.
  std::string name(std::size_t i) const;
  /// The color of a run's curves and label, as ImGui packs it.
  static std::uint32_t packed_color(std::size_t i);
  /// After the runs moved: their images show the states of one time.
  void update();
  /// Divides the place of the scene between the runs.
  void place(const Box& whole);
  /// The places of all runs [window units]; one if there is only run 0.
  const std::vector<Box>& boxes() const { return boxes_; }
  /// Before images are drawn: those of one color and scale get the widest of their ranges, so that colors
  /// can be compared.
  void share_colors();
  /// Draws the other runs' images, after SceneImage::show() did that of run 0.
  Status show(const WindowSize& window);
  /// Of one of them a fine image is under way.
  bool refining() const;
  /// Names the runs on their images, between Gui::begin and end.
  void draw_labels(const Gui& gui) const;

 private:
  struct Rendered {
    const PlaybackSession* run = nullptr;
    std::unique_ptr<SceneImage> image;
  };
  void refuse(const Difference& difference, const Error& why);
  Result<Rendered> rendered(std::size_t i);
  void draw_ghost_label(const Gui& gui) const;

  Comparison& comparison_;
  SceneControl& scene_;
  View& view_;
  SceneImage& image_;
  Messages& messages_;
  BackendChoice asked_;
  gl::Context* context_ = nullptr;
  std::vector<Rendered> images_;  // of runs 1, 2 …
  std::unique_ptr<SceneImage> ghost_;
  std::string ghost_source_;  // of its scene
  std::vector<Box> boxes_;
  std::uint64_t shown_number_ = 0;  // Comparison::shown_number() of the images
};

}  // namespace aspic::app
