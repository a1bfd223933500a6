#pragma once
// A perspective camera over a picture: matrices, and the way between world and pixels.
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <optional>

#include "model/vec3.h"
#include "scene/scene.h"

namespace aspic {

/// A half line; direction of unit length.
struct Ray {
  Vec3 origin;     ///< [m]
  Vec3 direction;  ///< unit
};

/// Where a point appears.
struct Projected {
  double x = 0.0, y = 0.0;  ///< [pixels] from the left and from the top; outside the picture is legal
  double distance = 0.0;    ///< along the camera's axis [m], > 0
};

class Camera {
 public:
  /// `settings` as a scene accepts them; a picture of width × height pixels, both ≥ 1. Up is +y, or −z where
  /// the camera looks straight up or down.
  Camera(const CameraSettings& settings, int width, int height);

  const glm::mat4& view() const { return view_; }
  const glm::mat4& projection() const { return projection_; }
  const glm::vec3& eye() const { return eye_; }
  /// From the eye to the target [m].
  float target_distance() const { return target_distance_; }

  /// The pixel a point appears at; nothing for a point next to or behind the camera.
  std::optional<Projected> project(const Vec3& point) const;
  /// The sight line through a place of the picture [pixels from left and top].
  Ray ray_through(double x, double y) const;
  /// How many pixels a metre is, square to the axis at that distance [pixels/m].
  double pixels_per_metre(double distance) const;

 private:
  glm::mat4 view_, projection_;
  glm::vec3 eye_;
  float target_distance_ = 1.0f;
  int width_, height_;
};

}  // namespace aspic
