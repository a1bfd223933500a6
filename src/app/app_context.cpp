// The part of App that holds on to a context, and lets go of one that was lost.
#include "app/app.h"
#include "run/backends.h"

namespace aspic::app {

/// Renderer and panels, in the context.
Status App::make_pictures(double scale, WindowServices services) {
  const auto directory = shader_directory();
  if (!directory) return directory.error();
  RendererOptions look;
  look.samples = draws_in_full() ? 4 : 1;
  look.shaders = gl::ShaderLibrary(*directory);
  auto renderer = Renderer::create(*context_, look);
  if (!renderer) return renderer.error();
  auto gui = Gui::create(scale, std::move(services));
  if (!gui) return gui.error();
  renderer_ = std::move(*renderer);
  gui_ = std::move(*gui);
  gui_->set_text_size(layout_.text_size);
  return {};
}

Status App::release_context(const Error& why) {
  for (const std::string& line : finish_films()) tell(line, true);
  ASPIC_CHECK(simulation_->leave_gpu(why));
  // What the solver said when it noticed first says more.
  if (!notice_ || !notice_->is_error) tell(why.message, true);
  end_pull();
  asked_.reset();
  hovered_.reset();
  drag_button_ = -1;
  renderer_.reset();
  gui_.reset();
  context_ = nullptr;
  return {};
}

Status App::adopt_context(gl::Context& context, double scale, WindowServices services) {
  context_ = &context;
  simulation_->set_context(context);
  drawn_model_ = drawn_state_ = ~std::uint64_t{0};
  return make_pictures(scale, std::move(services));
}

}  // namespace aspic::app
