#include "app/revival.h"

#include <array>

namespace aspic::app {

Result<std::unique_ptr<Window>> replace_window(App& app, std::unique_ptr<Window> window, const Error& why) {
  const std::array<int, 4> place = window->place();
  window->set_receiver(nullptr);
  ASPIC_CHECK(app.release_context(why));
  window.reset();
  auto other = Window::create(place[2], place[3], app.title(), std::array<int, 2>{place[0], place[1]});
  if (!other) return other;
  const Status adopted =
      app.adopt_context((*other)->context(), (*other)->content_scale(), (*other)->services());
  if (!adopted) return adopted.error();
  (*other)->set_receiver(&app);
  return other;
}

}  // namespace aspic::app
