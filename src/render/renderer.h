#pragma once
// Draws a model's particles, wherever they come from, as an image: the same code for window and file.
#include <array>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "aspic/scene.h"
#include "aspic/state.h"
#include "base/result.h"
#include "device/device_state.h"
#include "device/layout.h"
#include "gpu/buffer.h"
#include "gpu/context.h"
#include "gpu/pass_profiler.h"
#include "gpu/shader_source.h"
#include "gpu/texture.h"
#include "model/model.h"
#include "render/arrows.h"
#include "render/camera.h"
#include "render/color_map.h"
#include "render/frame_policy.h"
#include "render/highlight.h"
#include "render/overlay.h"
#include "render/picker.h"
#include "render/quantity.h"

namespace aspic {

struct RendererOptions {
  int samples = 4;  ///< per pixel, 1 … what the device offers; fewer are taken where it has fewer
  gl::ShaderLibrary shaders{};  ///< where shaders come from
};

/// How a ball is turned: a quaternion, its real part last.
using BallTurn = std::array<float, 4>;

/// What an image shows besides the particles.
struct ImageOptions {
  ViewSettings view;
  std::vector<OverlayLine> text;       ///< empty: no panel
  int text_height = 0;                 ///< [pixels], at most 256; 0: a share of the image's height
  bool legend = true;                  ///< of colors, where they mean something
  std::optional<Color> background;     ///< instead of terrain and sky, linear light; its alpha is 0
  bool shadows = true;                 ///< on terrain; without them light maps are left out
  int samples = 0;                     ///< per pixel, at most the renderer's; 0: those
  bool coarse_skin = false;            ///< fewer triangles for large bodies: for software rasterizers
  std::optional<QuantityRange> range;  ///< ends of the scale of colors; absent: the view's
  std::optional<Color> tint;           ///< of bodies colored by material, instead of their own
  ArrowSet arrows;                     ///< of those that the view asks for
  bool steady = false;                 ///< the next image has this camera: a backdrop is worth it
  std::vector<double> channels;        ///< of the inputs (Inputs::channels): signals that rest lengths follow
  std::vector<BallTurn> ball_turns;    ///< of each ball; empty: by the images drawn before
  bool axes = true;                    ///< in a corner, where the view asks for them
  std::optional<HighlightOptions> highlight;  ///< marks on particles; absent: none, not even on pinned ones
};

/// Everything of OpenGL that images need. The context must outlive it; every call enters it
/// (gpu/current.h), and where it is in use on another thread, calls without a Status do nothing. The state of
/// the context that it changes it leaves as OpenGL starts with, bindings excepted.
class Renderer {
 public:
  /// Makes the textures. Shaders are compiled by the images that need them first. Error (scene_rejected):
  /// no device memory.
  static Result<std::unique_ptr<Renderer>> create(gl::Context& context, const RendererOptions& options = {});
  ~Renderer();
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;

  /// What spares a software rasterizer; null: hardware draws.
  FramePolicy* policy() const;

  /// Takes on a model, which must outlive the renderer or the next set_model.
  /// Error (scene_rejected): no device memory for it.
  Status set_model(const Model& model);

  /// Copies a state of the model to the device, for solvers that do not live there, and returns where it
  /// lies, valid until the next call. The state has as many particles and balls as the model. Error
  /// (scene_rejected): no device memory.
  Result<DeviceState> upload(const State& state);

  /// The same for a state that packed_particles() and packed_balls() made ready.
  Result<DeviceState> upload(std::vector<layout::Particle> particles, std::vector<layout::Ball> balls,
                             std::uint64_t step);

  /// Draws width × height pixels of a state of the model. Balls appear turned by what they have rotated since
  /// the model was set, as far as the images drawn since then tell. Legal after set_model. Errors:
  /// scene_rejected or no_device, an image of this size cannot be made; no_device, a shader is refused; io,
  /// a shader file is missing.
  Status draw(int width, int height, const DeviceState& state, const ImageOptions& options);

  /// Begins to draw the same image in parts, so that a window need not wait for all of it: the image last
  /// drawn is shown on until proceed() says that this one is finished. Everything must stay as it is till
  /// then; draw() and set_model() give it up. Errors: those of draw().
  Status begin(int width, int height, const DeviceState& state, const ImageOptions& options);
  /// Draws the next part, and waits for it where there is a policy. Whether the image is finished: it has
  /// every byte that draw() would have given it. Legal after begin(). Errors: those of draw().
  Result<bool> proceed();

  /// Asks what lies under a place of the image last drawn, as it is shown in a view of place.width ×
  /// place.height pixels; its state must still lie where it was. Legal after draw() of the model. Returns the
  /// request's number, counted from 1. Errors: no_device (a shader is refused), io, scene_rejected.
  Result<std::uint64_t> request_pick(const PickPlace& place);
  /// The newest answer that has come back, as a rule that of the image before; never waits for the device.
  PickAnswer picked() const;

  /// The ends that a view's color scale would have in an image of this state of the model. Waits for the
  /// device where they follow the image. Legal after set_model. Errors: those of draw().
  /// `channels`: as ImageOptions has them.
  Result<QuantityRange> range_of(const DeviceState& state, const ViewSettings& view,
                                 std::span<const double> channels = {});

  /// The ends of the color scale of the image last drawn. Legal after draw().
  QuantityRange range() const;

  /// The image last drawn: one sample, sRGB encoded values. Legal after draw().
  const gl::Framebuffer& image() const;
  /// Puts the image last drawn into a window's framebuffer (0: the default one), stretched to
  /// width × height pixels whose lower left corner is (left, bottom). The framebuffer takes encoded values as
  /// they are.
  void present(std::uint32_t framebuffer, int width, int height, int left = 0, int bottom = 0) const;

  /// Lays what the bodies of the image last drawn cover over a window's framebuffer, pale and translucent;
  /// the image was drawn with this background.
  void present_ghost(const Color& background, std::uint32_t framebuffer, int width, int height, int left,
                     int bottom) const;

  /// Marks particles on top of the image last drawn where it was presented, without redrawing it; its
  /// state must still lie where it was. Error: scene_rejected, no_device or io.
  Status present_highlight(const HighlightOptions& options, std::uint32_t framebuffer, int width, int height,
                           int left = 0, int bottom = 0);

  /// Whether the images from now on are told apart by pass; off at first. On software rasterizers each pass
  /// then waits for the one before, which costs a little itself.
  void set_profiling(bool on);
  /// Means over the last images that were measured, by pass (frame_passes.h); empty without profiling.
  std::vector<gl::PassTime> pass_times();

  /// For tests and probes: normals as of the last draw of solid bodies, one by vertex of make_surface().
  std::vector<Vec3> normals() const;

 private:
  struct Parts;
  explicit Renderer(std::unique_ptr<Parts> parts);
  std::unique_ptr<Parts> parts_;
};

}  // namespace aspic
