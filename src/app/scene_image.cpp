#include "app/scene_image.h"

#include <glad/gl.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <span>

#include "base/stopwatch.h"
#include "io/atomic_file.h"
#include "io/video_format.h"
#include "render/color_map.h"
#include "render/overlay_text.h"
#include "render/state_arrows.h"

namespace aspic::app {
namespace {

/// Particles from which on a first image may take too long.
constexpr std::uint32_t many_particles = 8000;

/// Seen through a ghost's bodies, which take its brightness on.
constexpr Color behind_ghost = {0.55f, 0.60f, 0.66f};

using Clock = std::chrono::steady_clock;

int rounded(double length) {
  return static_cast<int>(std::lround(length));
}

}  // namespace

Status SceneImage::attach(gl::Context& context) {
  ASPIC_TRY(const auto directory, gl::shader_directory());
  context_ = &context;
  RendererOptions look;
  look.shaders = gl::ShaderLibrary(directory);
  ASPIC_TRY(renderer_, Renderer::create(context, look));
  drawn_.reset();
  drawn_particles_ = 0;
  return {};
}

void SceneImage::detach() {
  refined_.reset();
  renderer_.reset();
  context_ = nullptr;
}

SceneImage::Pixels SceneImage::view_pixels(int window_height) const {
  const double ratio = view_.pixels_per_unit;
  const Box& box = place_ ? *place_ : view_.box;
  Pixels p;
  p.left = rounded(box.left * ratio);
  p.bottom = window_height - rounded(box.bottom * ratio);
  p.width = std::max(rounded(box.right * ratio) - p.left, 1);
  p.height = std::max(rounded((box.bottom - box.top) * ratio), 1);
  return p;
}

SceneImage::Content SceneImage::wanted(bool fine) const {
  Content c;
  c.model = simulation_.present().model_number();
  c.state = kept() ? 0 : simulation_.present().image_number();
  c.kept = kept() ? kept_number_ : 0;
  c.view = scene_.view;
  c.view.camera = view_.seen(offset_);
  c.shadows = shadows;
  c.range = common_range;
  c.tint = tint;
  c.video = video;
  c.fine = in_full() || (fine && !video);
  const double scale = c.fine ? 1.0 : policy()->resolution.share();
  const Pixels full = view_pixels(0);
  c.size =
      video ? video->size
            : ImageSize{std::max(rounded(scale * full.width), 1), std::max(rounded(scale * full.height), 1)};
  if (const auto& hand = simulation_.hand(); hand && !hand->ball)
    c.marks.pull = {hand->particle, hand->anchor};
  for (const auto& [particle, pinned] : simulation_.present().setup().pinned)
    if (pinned) c.marks.marked.push_back(particle);
  c.marks.unit = view_.text_scale * c.size.width / view_.width();
  return c;
}

Status SceneImage::follow() {
  if (ghost) {
    // It is seen with the image that it lies over.
    offset_ = view_.offset();
    return {};
  }
  const std::pair wanted(simulation_.present().model_number(), scene_.view.follow);
  if (followed_ != wanted) following_ = Following(scene_, simulation_.model(), Precision::single);
  followed_ = wanted;
  if (following_.any() && !kept()) ASPIC_CHECK(refresh());
  offset_ = following_.offset(simulation_.model(), shown_state());
  if (!place_) view_.follow(scene_.view.follow, offset_);
  return {};
}

/// The snapshot becomes the state that is drawn.
Status SceneImage::refresh() {
  const bool old = simulation_.present().device_state() && simulation_.snapshot().step != simulation_.step();
  return old ? simulation_.refresh_snapshot() : Status();
}

Status SceneImage::draw() {
  ASPIC_CHECK(follow());
  const Content content = wanted(at_rest);
  if (drawn_ == content || (drawn_ && drawn_->fine && drawn_ == wanted(true))) return {};
  if (content.fine && !in_full() && !at_once && drawn_ == wanted(false)) return refine(content);
  return draw(content, video && video->draws_legend(), ghost ? std::optional(behind_ghost) : std::nullopt);
}

/// Draws some parts of the fine image, which takes the place of the coarse one once it is whole.
Status SceneImage::refine(const Content& content) {
  const auto start = Clock::now();
  const std::optional<Color> background = ghost ? std::optional(behind_ghost) : std::nullopt;
  if (refined_ != content) {
    ASPIC_TRY(const ImageOptions options, options_of(content, false, background));
    ASPIC_TRY(const DeviceState state, on_device());
    // What the device has no room for draw() may draw otherwise.
    if (!renderer_->begin(content.size.width, content.size.height, state, options))
      return draw(content, false, background);
    refined_ = content;
    refined_seconds_ = 0.0;
  }
  bool finished = false;
  do {
    ASPIC_TRY(finished, renderer_->proceed());
  } while (!finished && seconds_since(start) < part_seconds);
  refined_seconds_ += seconds_since(start);
  if (!finished) return {};
  refined_.reset();
  drawn_ = content;
  ++number_;
  rate.draw_seconds = refined_seconds_;
  return {};
}

/// Also takes note of the arrows in it.
Result<ImageOptions> SceneImage::options_of(const Content& content, bool legend,
                                            const std::optional<Color>& background) {
  ImageOptions options;
  options.legend = legend;
  options.background = background;
  options.samples = content.fine ? 0 : 1;
  options.range = content.range;
  options.tint = content.tint;
  options.view = content.view;
  if (video && video->text)
    options.text = video->label.empty() ? overlay_lines(scene_, simulation_.time()) : video->label;
  if (video) options.text_height = video->text_height;
  options.shadows = shadows;
  options.axes = legend || (video && !ghost);
  // Of the very state that is drawn, and with the inputs that acted in it.
  if (options.view.arrows.any() && !kept()) ASPIC_CHECK(refresh());
  const Playback& playback = simulation_.playback();
  const Inputs& inputs =
      playback.at_end() ? simulation_.inputs() : playback.history().inputs_at(playback.here());
  if (!ghost) arrows_ = arrows_of(simulation_.model(), shown_state(), options.view.arrows, inputs);
  options.arrows = arrows_;
  options.channels = inputs.channels;
  options.highlight = content.marks;
  return options;
}

Status SceneImage::draw(const Content& content, bool legend, const std::optional<Color>& background) {
  const auto start = Clock::now();
  const bool new_model = !is_of_model(), adapts = !content.fine && !video;
  FramePolicy* const spared = renderer_->policy();
  const double share = spared ? spared->resolution.share() : 1.0;
  refined_.reset();
  ASPIC_TRY(ImageOptions options, options_of(content, legend, background));
  options.coarse_skin = adapts && share < 1.0;
  if (new_model) {
    const Model& model = simulation_.model();
    ASPIC_CHECK(renderer_->set_model(model));
    if (spared && drawn_particles_ != model.particle_count())
      spared->resolution.reset(model.particle_count() > many_particles);
    drawn_particles_ = model.particle_count();
  }
  ASPIC_TRY(const DeviceState state, on_device());
  Status drawn = renderer_->draw(content.size.width, content.size.height, state, options);
  if (!drawn && drawn.error().code == ErrorCode::scene_rejected && has_scale(options.view.color)) {
    // What a color needs of the device may be more than it has: the scene goes on without.
    refusal_ = "Cannot show this color: " + drawn.error().what;
    options.view.color = ViewColor::material;
    drawn = renderer_->draw(content.size.width, content.size.height, state, options);
  }
  if (!drawn) return drawn.error();
  if (spared) spared->wait();
  drawn_ = content;
  ++number_;
  rate.draw_seconds = seconds_since(start);
  if (adapts && !new_model) {
    const bool late = simulation_.running() && simulation_.pacer().late();
    spared->resolution.took(share, rate.draw_seconds, late ? Resolution::hurried : Resolution::in_motion);
  }
  return {};
}

/// Where the state that is drawn lies.
Result<DeviceState> SceneImage::on_device() {
  if (const auto state = kept() ? std::nullopt : simulation_.present().device_state()) return *state;
  return renderer_->upload(shown_state());
}

void SceneImage::keep(std::optional<State> state) {
  kept_ = std::move(state);
  ++kept_number_;
}

const State* SceneImage::kept() const {
  const Model& model = simulation_.model();
  const bool fits = kept_ && kept_->position.size() == model.particle_count() &&
                    kept_->ball_position.size() == model.ball_count();
  return fits ? &*kept_ : nullptr;
}

Status SceneImage::show(const WindowSize& window, const Box& place) {
  place_ = place;
  return present(window);
}

Status SceneImage::show(const WindowSize& window) {
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  glViewport(0, 0, window.pixel_width, window.pixel_height);
  glClearColor(0.105f, 0.107f, 0.112f, 1.0f);
  glClear(GL_COLOR_BUFFER_BIT);
  return present(window);
}

Status SceneImage::present(const WindowSize& window) {
  const Pixels view = view_pixels(window.pixel_height);
  // Nothing but the image may be used of the renderer while it is postponed: its model is gone.
  if (!std::exchange(postponed, false) || !drawn_ || video) {
    ASPIC_CHECK(draw());
  }
  Pixels& p = shown_pixels_ = view;
  if (video) {
    // A video of another shape than the view is shown complete, between margins.
    const auto [width, height] = video->size;
    const double fit =
        std::min(static_cast<double>(view.width) / width, static_cast<double>(view.height) / height);
    p.width = rounded(fit * width);
    p.height = rounded(fit * height);
    p.left += (view.width - p.width) / 2;
    p.bottom += (view.height - p.height) / 2;
  }
  if (ghost)
    renderer_->present_ghost(behind_ghost, 0, p.width, p.height, p.left, p.bottom);
  else
    renderer_->present(0, p.width, p.height, p.left, p.bottom);
  const double ratio = view_.pixels_per_unit;
  shown_ = {p.left / ratio, (window.pixel_height - p.bottom - p.height) / ratio, (p.left + p.width) / ratio,
            (window.pixel_height - p.bottom) / ratio};
  return {};
}

Status SceneImage::mark(std::uint32_t particle) {
  HighlightOptions ring;
  ring.hovered = particle;
  ring.unit = view_.text_scale * view_.pixels_per_unit;
  ring.pinned = false;
  const Pixels& p = shown_pixels_;
  return renderer_->present_highlight(ring, 0, p.width, p.height, p.left, p.bottom);
}

Result<std::uint64_t> SceneImage::request_pick(double x, double y) {
  return renderer_->request_pick(
      {x - shown_.left, y - shown_.top, shown_.right - shown_.left, shown_.bottom - shown_.top});
}

Legend SceneImage::arrow_legend() const {
  if (video && video->text) return {};
  return aspic::arrow_legend(scene_.view, arrows_);
}

QuantityRange SceneImage::range() const {
  const bool drawn =
      is_of_model() && drawn_->view.color == scene_.view.color && drawn_->view.scale == scene_.view.scale;
  if (drawn) return renderer_->range();
  return range_for(simulation_.model(), scene_.view, {});
}

QuantityRange SceneImage::own_range() {
  const QuantityRange alone = range_for(simulation_.model(), scene_.view, {});
  if (!follows_image(scene_.view) || !is_of_model()) return alone;
  // Of what there is to measure: neither size nor camera.
  Content content;
  content.model = simulation_.present().model_number();
  content.state = kept() ? 0 : simulation_.present().image_number();
  content.kept = kept() ? kept_number_ : 0;
  content.view = scene_.view;
  if (measured_ == content) return own_range_;
  measured_ = content;
  const auto state = on_device();
  const auto range = state ? renderer_->range_of(*state, scene_.view) : Result<QuantityRange>(alone);
  own_range_ = range ? *range : alone;
  return own_range_;
}

Legend SceneImage::legend() const {
  if (video && video->text) return {};
  return legend_for(scene_.view, range());
}

namespace {

/// RGB, rows from the top.
std::vector<std::byte> pixels_of(std::uint32_t framebuffer, const ImageSize& size, int left = 0,
                                 int bottom = 0) {
  const auto row = 3 * static_cast<std::size_t>(size.width), height = static_cast<std::size_t>(size.height);
  std::vector<std::byte> below(row * height), rgb(below.size());
  glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer);
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(left, bottom, size.width, size.height, GL_RGB, GL_UNSIGNED_BYTE, below.data());
  glPixelStorei(GL_PACK_ALIGNMENT, 4);
  glBindFramebuffer(GL_READ_FRAMEBUFFER, 0);
  for (std::size_t i = 0; i < height; ++i)
    std::copy_n(below.begin() + static_cast<std::ptrdiff_t>((height - 1 - i) * row), row,
                rgb.begin() + static_cast<std::ptrdiff_t>(i * row));
  return rgb;
}

Status write_image(const std::string& path, const Result<std::string>& png) {
  if (!png) return png.error();
  ASPIC_TRY(auto file, AtomicFile::create(path, Overwrite::refuse));
  ASPIC_CHECK(file.write(*png));
  return file.commit();
}

/// What bodies look like and how much they cover, from images of them before black and before white: light
/// that comes through is what the two differ by.
std::vector<std::byte> uncovered(std::span<const std::byte> on_black, std::span<const std::byte> on_white) {
  const auto light = [](std::byte b) { return srgb_to_linear(std::to_integer<int>(b) / 255.0); };
  const auto rounded_byte = [](double x) {
    return static_cast<std::byte>(std::lround(255.0 * std::clamp(x, 0.0, 1.0)));
  };
  std::vector<std::byte> rgba;
  rgba.reserve(on_black.size() / 3 * 4);
  for (std::size_t i = 0; i < on_black.size(); i += 3) {
    double through = 0.0;
    for (std::size_t c = i; c < i + 3; ++c) through += (light(on_white[c]) - light(on_black[c])) / 3.0;
    const double cover = std::clamp(1.0 - through, 0.0, 1.0);
    for (std::size_t c = i; c < i + 3; ++c)
      rgba.push_back(cover > 0.0 ? rounded_byte(linear_to_srgb(std::min(light(on_black[c]) / cover, 1.0)))
                                 : std::byte{0});
    rgba.push_back(rounded_byte(cover));
  }
  return rgba;
}

}  // namespace

Status SceneImage::save_clear(const Content& content, const std::string& path) {
  ASPIC_CHECK(draw(content, false, Color{0.0f, 0.0f, 0.0f}));
  const std::vector<std::byte> on_black = pixels_of(renderer_->image().id(), content.size);
  ASPIC_CHECK(draw(content, false, Color{1.0f, 1.0f, 1.0f}));
  return write_image(
      path,
      encode_clear_png(content.size, uncovered(on_black, pixels_of(renderer_->image().id(), content.size))));
}

Status SceneImage::save(const std::string& path) {
  const Content own = wanted(true);
  Content content = own;
  const double scale = video ? 1.0 : SavedLook::scales[saved.scale];
  content.size = {rounded(scale * own.size.width), rounded(scale * own.size.height)};
  content.marks.unit *= static_cast<decltype(content.marks.unit)>(scale);
  Status written;
  if (saved.clear)
    written = save_clear(content, path);
  else if (written = draw(content, true); written)
    written = save_pixels(renderer_->image().id(), content.size, path);
  // The window's own has no legend, its own size and what is around the bodies.
  if (content.size != own.size || saved.clear || !legend().empty() || !arrow_legend().empty() ||
      scene_.view.axes)
    ASPIC_CHECK(draw(own, false));
  return written;
}

Status save_pixels(std::uint32_t framebuffer, const ImageSize& size, const std::string& path, int left,
                   int bottom) {
  return write_image(path, encode_png(size, pixels_of(framebuffer, size, left, bottom)));
}

}  // namespace aspic::app
