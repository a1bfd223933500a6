#pragma once
// From the world to pixels, the way back of Camera::ray_through().
#include <glm/vec4.hpp>
#include <optional>

#include "render/camera.h"

namespace aspic::test {

/// Where a point appears.
struct Projected {
  double x = 0.0, y = 0.0;  ///< [pixels] from the left and from the top; outside the image is legal
  double distance = 0.0;    ///< along the camera's axis [m], > 0
};

/// The pixel a point appears at; nothing for a point next to or behind the camera.
inline std::optional<Projected> project(const Camera& camera, const Vec3& point) {
  const glm::vec4 world(static_cast<float>(point.x), static_cast<float>(point.y), static_cast<float>(point.z),
                        1.0f);
  const glm::vec4 clip = camera.projection() * camera.view() * world;
  if (clip.w <= 0.0f) return std::nullopt;
  return Projected{(0.5 + 0.5 * static_cast<double>(clip.x / clip.w)) * camera.width(),
                   (0.5 - 0.5 * static_cast<double>(clip.y / clip.w)) * camera.height(),
                   static_cast<double>(clip.w)};
}

/// How many pixels a meter is, square to the axis at that distance [pixels/m].
inline double pixels_per_meter(const Camera& camera, double distance) {
  return 0.5 * camera.height() * static_cast<double>(camera.projection()[1][1]) / distance;
}

}  // namespace aspic::test
