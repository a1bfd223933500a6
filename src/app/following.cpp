// What the key that follows does.
#include <fmt/format.h>

#include <optional>
#include <string>

#include "app/app.h"
#include "app/panels.h"
#include "scene/follow.h"

namespace aspic::app {

void App::follow_hovered() {
  const auto& h = pointer.hovered();
  std::optional<std::string> name;
  if (h && h->ball &&
      h->particle >= simulation.model().ball_count() - simulation.present().setup().thrown.size())
    return messages.refuse(
        "The camera follows bodies and balls of the scene; this ball was thrown with the mouse.");
  if (h)
    name = h->ball ? name_of_ball(h->particle)
                   : name_of_body(scene.scene().model, simulation.model(), h->particle);
  const auto& now = scene.scene().view.follow;
  if (!name && !now)
    return messages.info("Point at a body or ball of the scene to follow it, or choose one under View.");
  if (name == now) name.reset();
  set_followed(scene, name);
  messages.info(name ? fmt::format("The camera follows {}.", *name) : "The camera no longer follows a body.");
}

}  // namespace aspic::app
