#pragma once
// The image of the scene in the window: drawn where something changed, kept where nothing did.
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/frame_rate.h"
#include "app/view.h"
#include "app/window.h"
#include "playback/playback_session.h"
#include "render/renderer.h"
#include "scene/follow.h"

namespace aspic::app {

/// How a video wants its images.
struct VideoLook {
  ImageSize size;                       ///< whatever becomes of the window
  bool text = false;                    ///< parameters, time and the legend of colors are written on them
  bool legend = true;                   ///< that legend is, and no other image of the video has it
  std::vector<OverlayLine> label = {};  ///< instead of parameters and time
  int text_height = 0;                  ///< [pixels]; 0: that of ImageOptions
  bool draws_legend() const { return text && legend; }
  friend bool operator==(const VideoLook&, const VideoLook&) = default;
};

/// How an image is saved.
struct SavedLook {
  static constexpr std::array<double, 3> scales = {1.0, 2.0, 4.0};
  std::size_t scale = 0;  ///< of `scales`: pixels for each of the view's, in each direction
  bool clear = false;     ///< without sky and terrain; what the bodies do not cover is transparent
};

class SceneImage {
 public:
  /// The references must outlive it. `in_full_quality`: a software rasterizer draws as hardware does.
  SceneImage(PlaybackSession& simulation, const Scene& scene, View& view, bool in_full_quality)
      : full_quality(in_full_quality), simulation_(simulation), scene_(scene), view_(view) {}

  bool full_quality;
  /// Nothing has moved for a while, or something does: at rest a software rasterizer draws one image as
  /// finely as hardware does, which stays until something in it changes. It does so a part at a time, between
  /// which the window answers, and shows the image before meanwhile; or `at_once`.
  bool at_rest = false, at_once = false;
  double part_seconds = 0.02;      ///< of a fine image, before events are looked at again [s]
  bool postponed = false;          ///< show() shows the last image once more: events come first
  bool shadows = true;             ///< on terrain
  std::optional<VideoLook> video;  ///< while a video is made
  SavedLook saved;                 ///< of the next save()
  FrameRate rate;
  std::optional<Color> tint;                  ///< of bodies colored by material; absent: their own
  std::optional<QuantityRange> common_range;  ///< of colors, where runs are compared; absent: its own
  bool ghost = false;  ///< its bodies alone, pale and translucent over what the window shows

  /// Everything of OpenGL, in a context that must outlive it or be detached. Errors: of Renderer::create.
  Status attach(gl::Context& context);
  void detach();
  gl::Context& context() const { return *context_; }

  /// Between attach() and detach(): null where hardware draws.
  const FramePolicy* policy() const { return renderer_->policy(); }
  /// A part of the fine image is drawn, and more is to come.
  bool refining() const { return refined_.has_value(); }
  /// Moves the camera along with what the scene's view follows, to the very state that draw() draws; draw()
  /// does so itself. Error: the state cannot be read.
  Status follow();
  /// How far it was moved along [m].
  const Vec3& offset() const { return offset_; }
  /// Draws the image, if anything in it changed. Error: of Renderer.
  Status draw();
  /// Draws it and puts it into the window.
  Status show(const WindowSize& window);
  /// The same for the image of another run at a place of its own in the window, which keeps what else is
  /// there.
  Status show(const WindowSize& window, const Box& place);
  /// From now on this state is shown, whatever becomes of the simulation, until the next one; nothing: the
  /// simulation's again.
  void keep(std::optional<State> state);
  /// Why the last image does not have the color that was asked for, once.
  std::optional<std::string> take_refusal() { return std::exchange(refusal_, std::nullopt); }
  /// Marks a particle in the window, on top of what show() put there. So the mark follows the mouse however
  /// long images take, and is in no video.
  Status mark(std::uint32_t particle);
  /// The state that it shows.
  const State& shown_state() const {
    const State* const held = kept();
    return held ? *held : simulation_.snapshot();
  }
  const gl::Framebuffer& pixels() const { return renderer_->image(); }
  /// Draws it as finely as hardware does, with the legend of its colors, and saves it as a new PNG file.
  /// Errors: of Renderer; io.
  Status save(const std::string& path);

  /// Where the last image is in the window [window units]; a video of another shape has margins.
  const Box& shown() const { return shown_; }
  std::uint64_t number() const { return number_; }
  /// Whether indices in the last image are those of the simulation's model.
  bool is_of_model() const { return drawn_ && drawn_->model == simulation_.present().model_number(); }
  /// Asks what lies at a place in the window [window units]; see Renderer::request_pick.
  Result<std::uint64_t> request_pick(double x, double y);
  PickAnswer picked() const { return renderer_->picked(); }

  /// The ends of the scale of its colors.
  QuantityRange range() const;
  /// Those that the image to come would have if it were the only one; of one that has not been drawn since
  /// the model became another those that suit the model.
  QuantityRange own_range();
  /// What the colors of the image mean; empty where they mean nothing, or the image says so itself.
  Legend legend() const;
  /// The same of its arrows.
  Legend arrow_legend() const;

 private:
  /// What the last image shows, and how.
  struct Content {
    std::uint64_t model = 0, state = 0, kept = 0;
    ViewSettings view;
    HighlightOptions marks;
    bool shadows = true, fine = true;
    std::optional<QuantityRange> range;
    std::optional<Color> tint;
    std::optional<VideoLook> video;
    ImageSize size;
    friend bool operator==(const Content&, const Content&) = default;
  };
  struct Pixels {
    int left = 0, bottom = 0, width = 1, height = 1;
  };
  bool in_full() const { return full_quality || !policy(); }
  Pixels view_pixels(int window_height) const;
  Status present(const WindowSize& window);
  /// What is kept, if it is one of the simulation's model.
  const State* kept() const;
  Status refresh();
  Result<DeviceState> on_device();
  Content wanted(bool fine) const;
  Result<ImageOptions> options_of(const Content& content, bool legend,
                                  const std::optional<Color>& background);
  Status refine(const Content& content);
  Status draw(const Content& content, bool legend, const std::optional<Color>& background = {});
  Status save_clear(const Content& content, const std::string& path);

  PlaybackSession& simulation_;
  const Scene& scene_;
  View& view_;
  std::optional<std::string> refusal_;
  std::optional<Box> place_;   // absent: the view's
  std::optional<State> kept_;  // that is shown; absent: the simulation's
  std::uint64_t kept_number_ = 0;
  Following following_;
  std::optional<Content> measured_;  // what own_range_ is of
  QuantityRange own_range_ = {};
  std::pair<std::uint64_t, std::optional<std::string>> followed_;  // model and name of following_
  Vec3 offset_;                                                    // of the camera [m]
  gl::Context* context_ = nullptr;
  std::unique_ptr<Renderer> renderer_;
  std::optional<Content> drawn_;
  std::optional<Content> refined_;  // the fine image that is drawn in parts
  double refined_seconds_ = 0.0;    // what they took
  ArrowSet arrows_;                 // of the last image
  std::uint64_t number_ = 0;
  Box shown_;
  Pixels shown_pixels_;
  std::uint32_t drawn_particles_ = 0;
};

/// Saves the pixels of a framebuffer (0: the window's), from (left, bottom) on, as a new PNG file. Error
/// (io).
Status save_pixels(std::uint32_t framebuffer, const ImageSize& size, const std::string& path, int left = 0,
                   int bottom = 0);

}  // namespace aspic::app
