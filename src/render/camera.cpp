#include "render/camera.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/trigonometric.hpp>
#include <numbers>

#include "render/layout.h"

namespace aspic {

CameraSettings fitted(CameraSettings settings, double width, double height) {
  constexpr double degree = std::numbers::pi / 180.0;
  const double more = narrowest * height / width;
  if (more > 1.0)
    settings.fov = std::min(2.0 * std::atan(more * std::tan(0.5 * degree * settings.fov)) / degree, 179.0);
  return settings;
}

Camera::Camera(const CameraSettings& settings, int width, int height)
    : eye_(to_glm(settings.position)),
      width_(width),
      height_(height),
      orthographic_(settings.projection == Projection::orthographic) {
  assert(width >= 1 && height >= 1);
  const glm::vec3 target = to_glm(settings.target);
  target_distance_ = glm::length(target - eye_);
  assert(target_distance_ > 0.0f);
  const glm::vec3 forward = (target - eye_) / target_distance_;
  const glm::vec3 up = std::abs(forward.y) > 0.99999f ? glm::vec3(0, 0, -1) : glm::vec3(0, 1, 0);
  const float aspect = static_cast<float>(width) / static_cast<float>(height);
  const float angle = glm::radians(static_cast<float>(settings.fov));
  if (orthographic_) {
    const float up_to = target_distance_ * std::tan(0.5f * angle);
    eye_ = target - ORTHOGRAPHIC_DISTANCE * target_distance_ * forward;
    view_ = glm::lookAt(eye_, target, up);
    projection_ = glm::ortho(-aspect * up_to, aspect * up_to, -up_to, up_to, 0.0f,
                             2.0f * ORTHOGRAPHIC_DISTANCE * target_distance_);
    return;
  }
  view_ = glm::lookAt(eye_, target, up);
  // The near plane follows the distance, so that depth has the same relative resolution in scenes of any
  // size.
  const float near = target_distance_ / 200.0f;
  projection_ = glm::perspective(angle, aspect, near, 40.0f * target_distance_);
}

Ray Camera::ray_through(double x, double y) const {
  const double right = (2.0 * x / width_ - 1.0) / static_cast<double>(projection_[0][0]);
  const double up = (1.0 - 2.0 * y / height_) / static_cast<double>(projection_[1][1]);
  const glm::dmat3 to_world = glm::transpose(glm::dmat3(view_));
  const double slope = orthographic_ ? 0.0 : 1.0;
  const glm::dvec3 d = glm::normalize(to_world * glm::dvec3(slope * right, slope * up, -1.0));
  const double ahead =
      orthographic_ ? (ORTHOGRAPHIC_DISTANCE - 1.0) * static_cast<double>(target_distance_) : 0.0;
  const glm::dvec3 e =
      glm::dvec3(eye_) + to_world * glm::dvec3((1.0 - slope) * right, (1.0 - slope) * up, -ahead);
  return {{e.x, e.y, e.z}, {d.x, d.y, d.z}};
}

}  // namespace aspic
