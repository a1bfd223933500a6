#include "app/revival.h"

namespace aspic::app {

Result<std::unique_ptr<Window>> replace_window(App& app, std::unique_ptr<Window> window, const Error& why) {
  const WindowPlace place = window->place();
  window->set_receiver(nullptr);
  ASPIC_CHECK(app.release_context(why));
  window.reset();
  auto other = Window::create(place.width, place.height, app.title(), place.position);
  if (!other) return other;
  const Status adopted =
      app.adopt_context((*other)->context(), (*other)->content_scale(), (*other)->services());
  if (!adopted) return adopted.error();
  (*other)->set_receiver(&app);
  return other;
}

}  // namespace aspic::app
