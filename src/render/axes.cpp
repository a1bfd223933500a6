#include "render/axes.h"

#include <algorithm>

namespace aspic {

std::array<AxisArm, 3> axes_seen(const Camera& camera) {
  constexpr Color colors[] = {{0.80f, 0.06f, 0.06f}, {0.10f, 0.55f, 0.08f}, {0.06f, 0.22f, 0.90f}};
  std::array<AxisArm, 3> arms;
  for (int i = 0; i < 3; ++i) {
    const glm::vec4& column = camera.view()[i];
    arms[static_cast<std::size_t>(i)] = {"xyz"[i], static_cast<double>(column[0]),
                                         -static_cast<double>(column[1]), -static_cast<double>(column[2]),
                                         colors[i]};
  }
  std::ranges::stable_sort(arms, std::ranges::greater{}, &AxisArm::away);
  return arms;
}

}  // namespace aspic
