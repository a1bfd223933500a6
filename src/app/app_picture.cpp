// The part of App that makes pictures: scene, hovering, screenshots.
#include <fmt/format.h>
#include <glad/gl.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <utility>

#include "app/app.h"
#include "io/atomic_file.h"
#include "io/film_format.h"
#include "render/camera.h"
#include "render/overlay_text.h"
#include "run/outputs.h"

namespace aspic::app {
namespace {

/// Particles from which on a first picture may take too long.
constexpr std::uint32_t many_particles = 8000;

}  // namespace

Status App::draw_scene(const WindowSize& size) {
  const double ratio = static_cast<double>(size.pixel_width) / size.width;
  pixels_per_unit_ = ratio;
  const int left = static_cast<int>(std::lround(viewport_.left * ratio));
  const int width = std::max(static_cast<int>(std::lround(viewport_.right * ratio)) - left, 1);
  const int bottom = size.pixel_height - static_cast<int>(std::lround(viewport_.bottom * ratio));
  const int height = std::max(static_cast<int>(std::lround((viewport_.bottom - viewport_.top) * ratio)), 1);
  // Once all stands still there is time for every pixel.
  const bool still = is_still();
  const double scale = draws_in_full() ? 1.0 : resolution_.share(still);
  const auto scaled = [scale](int length) {
    return std::max(static_cast<int>(std::lround(scale * length)), 1);
  };
  // A film keeps its size, whatever becomes of the window.
  const PictureSize picture =
      recording_ ? recording_->options().size : PictureSize{scaled(width), scaled(height)};
  // The first picture of a large model takes longer: after it was built events come first, and the old
  // picture stays. Nothing but the picture may be used of the renderer then, whose model is gone.
  const bool rest = std::exchange(rest_a_picture_, false) && drawn_width_ > 0 && !recording_;
  if (!rest) {
    ASPIC_CHECK(draw_picture(picture.width, picture.height));
  }
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  glViewport(0, 0, size.pixel_width, size.pixel_height);
  glClearColor(0.105f, 0.107f, 0.112f, 1.0f);
  glClear(GL_COLOR_BUFFER_BIT);
  // A film of another shape than the view is shown whole, between margins.
  const double fit =
      std::min(static_cast<double>(width) / picture.width, static_cast<double>(height) / picture.height);
  const int shown_width = recording_ ? static_cast<int>(std::lround(fit * picture.width)) : width;
  const int shown_height = recording_ ? static_cast<int>(std::lround(fit * picture.height)) : height;
  const int shown_left = left + (width - shown_width) / 2,
            shown_bottom = bottom + (height - shown_height) / 2;
  renderer_->present(0, shown_width, shown_height, shown_left, shown_bottom);
  std::ranges::copy(std::array{shown_left, shown_bottom, shown_width, shown_height}, shown_pixels_);
  shown_ = {shown_left / ratio, (size.pixel_height - shown_bottom - shown_height) / ratio,
            (shown_left + shown_width) / ratio, (size.pixel_height - shown_bottom) / ratio};
  if (rest) return {};
  ASPIC_CHECK(present_ring());
  return ask_what_is_under_mouse();
}

Status App::draw_picture(int width, int height) {
  PictureOptions options;
  options.view = editor_.scene().view;
  options.view.camera = camera_.shown();
  if (recording_) {
    options.legend = film_settings_.text;
    if (film_settings_.text) options.text = overlay_lines(editor_.scene().model, simulation_->time());
  }
  options.shadows = shadows_;
  options.highlight = marks(width);
  options.coarse_skin = !draws_in_full() && !recording_ && resolution_.share(is_still()) < 1.0;
  const bool new_model = drawn_model_ != simulation_->model_number();
  const bool same = !new_model && drawn_state_ == simulation_->picture_number() &&
                    drawn_view_ == options.view && drawn_marks_ == *options.highlight &&
                    drawn_shadows_ == options.shadows && drawn_width_ == width && drawn_height_ == height;
  if (same) return {};
  const auto start = std::chrono::steady_clock::now();
  if (new_model) {
    ASPIC_CHECK(renderer_->set_model(simulation_->model()));
    if (drawn_particles_ != simulation_->model().particle_count())
      resolution_.reset(simulation_->model().particle_count() > many_particles);
    drawn_particles_ = simulation_->model().particle_count();
  }
  std::optional<DeviceState> state = simulation_->device_state();
  if (!state) {
    const auto uploaded = renderer_->upload(simulation_->snapshot());
    if (!uploaded) return uploaded.error();
    state = *uploaded;
  }
  ASPIC_CHECK(renderer_->draw(width, height, *state, options));
  if (context_->info().is_software) glFinish();
  drawn_model_ = simulation_->model_number();
  drawn_state_ = simulation_->picture_number();
  drawn_view_ = options.view;
  drawn_marks_ = *options.highlight;
  drawn_shadows_ = options.shadows;
  ++pictures_drawn_;
  drawn_width_ = width;
  drawn_height_ = height;
  draw_seconds_ = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (!draws_in_full() && !new_model && !recording_)
    resolution_.took(resolution_.share(is_still()), draw_seconds_);
  return {};
}

void App::save_screenshot(const WindowSize& size) {
  screenshot_wanted_ = false;
  const auto width = static_cast<std::size_t>(size.pixel_width),
             height = static_cast<std::size_t>(size.pixel_height);
  std::vector<std::byte> below(3 * width * height), rgb(below.size());
  glBindFramebuffer(GL_READ_FRAMEBUFFER, 0);
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, size.pixel_width, size.pixel_height, GL_RGB, GL_UNSIGNED_BYTE, below.data());
  glPixelStorei(GL_PACK_ALIGNMENT, 4);
  for (std::size_t row = 0; row < height; ++row)
    std::copy_n(below.begin() + static_cast<std::ptrdiff_t>((height - 1 - row) * 3 * width), 3 * width,
                rgb.begin() + static_cast<std::ptrdiff_t>(row * 3 * width));
  const auto png = encode_png({size.pixel_width, size.pixel_height}, rgb);
  if (!png) return tell(png.error());
  const std::string path = free_name(editor_.source(), ".png");
  auto file = AtomicFile::create(path, Overwrite::refuse);
  if (!file) return tell(file.error());
  Status written = file->write(*png);
  if (written) written = file->commit();
  if (written)
    tell(fmt::format("Screenshot saved as {}.", path));
  else
    tell(written);
}

}  // namespace aspic::app
