#include "app/revival.h"

namespace aspic::app {

Result<std::unique_ptr<Window>> replace_window(App& app, std::unique_ptr<Window> window, const Error& why) {
  const WindowSize size = window->size();
  window->set_receiver(nullptr);
  if (const Status released = app.release_context(why); !released) return released.error();
  window.reset();
  auto other = Window::create(size.width, size.height, app.title());
  if (!other) return other;
  const Status adopted =
      app.adopt_context((*other)->context(), (*other)->content_scale(), (*other)->services());
  if (!adopted) return adopted.error();
  (*other)->set_receiver(&app);
  return other;
}

}  // namespace aspic::app
