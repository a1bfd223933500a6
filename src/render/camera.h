#pragma once
// A camera over an image: matrices, and the way between world and pixels.
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include "aspic/scene.h"
#include "aspic/vec.h"

namespace aspic {

inline glm::vec3 to_glm(const Vec3& v) {
  return {v.x, v.y, v.z};
}

/// A half line; direction of unit length.
struct Ray {
  Vec3 origin;     ///< [m]
  Vec3 direction;  ///< unit
};

/// Width/height below which an image shows more above and below, so that its sides are not cut.
inline constexpr double narrowest = 4.0 / 3.0;

/// The settings for an image of width × height, both > 0: a narrow one shows as much from side to side as
/// one of 4 : 3.
CameraSettings fitted(CameraSettings settings, double width, double height);

class Camera {
 public:
  /// `settings` as a scene accepts them; an image of width × height pixels, both ≥ 1. Up is +y, or −z where
  /// the camera looks straight up or down.
  Camera(const CameraSettings& settings, int width, int height);

  const glm::mat4& view() const { return view_; }
  const glm::mat4& projection() const { return projection_; }
  /// Of an orthographic camera, ORTHOGRAPHIC_DISTANCE times as far from the target as the settings say: as
  /// far before the target as it sees behind it.
  const glm::vec3& eye() const { return eye_; }
  bool orthographic() const { return orthographic_; }
  /// From the eye to the target, unit.
  glm::vec3 axis() const { return -glm::vec3(view_[0][2], view_[1][2], view_[2][2]); }
  /// From the settings' position to the target [m].
  float target_distance() const { return target_distance_; }

  /// Of the image [pixels].
  int width() const { return width_; }
  int height() const { return height_; }
  /// The sight line through a place of the image [pixels from left and top], from the settings' position
  /// or, of an orthographic camera, from beside it.
  Ray ray_through(double x, double y) const;

 private:
  glm::mat4 view_, projection_;
  glm::vec3 eye_;
  float target_distance_ = 1.0f;
  int width_, height_;
  bool orthographic_;
};

}  // namespace aspic
