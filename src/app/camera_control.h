#pragma once
// The camera under the mouse: orbit, pan and zoom of a goal that the shown camera follows smoothly.
#include <optional>

#include "aspic/scene.h"

namespace aspic::app {

class CameraControl {
 public:
  /// Starts at rest at `home`, which is shown to the bit until the camera is first moved.
  explicit CameraControl(const CameraSettings& home) : home_(home) { jump_to(home); }

  /// Turns about the target: dx, dy in heights of the view, to the right and down. One height is half a turn.
  /// The elevation stays within ±89°.
  void orbit(double dx, double dy);
  /// Moves the target with the mouse: dx, dy in heights of the view, to the right and down.
  void pan(double dx, double dy);
  /// Comes nearer by a tenth for each notch, or goes away for negative ones. What is seen at the target's
  /// distance at (dx, dy) stays where it is: heights of the view to the right and down from its middle, of a
  /// view with this field of view (0: the camera's own) [degrees].
  void zoom(double notches, double dx = 0.0, double dy = 0.0, double fov = 0.0);
  void reset();
  /// Turns to a sphere and backs off until it fits; direction and field of view stay. `aspect` is
  /// width/height of the view, > 0; a radius of 0 [m] is taken as a small one.
  void frame(const Vec3& center, double radius, double aspect);
  /// Turns to a point: the target comes to lie there, and the camera moves along with it.
  void center(const Vec3& point);
  /// Turns to where the eye sees the target along −direction, by the short way; target and distance stay. The
  /// length of `direction` does not matter; straight above is 89° up, with −z away from the eye.
  void look_from(const Vec3& direction);
  /// Goes elsewhere at once, with its target.
  void shift(const Vec3& by);
  /// Takes on a camera at once, without easing.
  void jump_to(const CameraSettings& settings) { goal_ = shown_ = orbit_of(settings); }
  /// From perspective to orthographic and back, at once; what is at the target's distance stays as large.
  void change_projection();
  /// A new home, which the camera does not go to by itself.
  void set_home(const CameraSettings& home) { home_ = home; }

  /// Moves the shown camera towards the goal for dt ≥ 0 [s]. True while it is under way.
  bool update(double dt);

  const CameraSettings& home() const { return home_; }
  CameraSettings shown() const { return settings_of(shown_); }
  /// Where the camera is going.
  CameraSettings goal() const { return settings_of(goal_); }

 private:
  /// A camera as angles about its target [radians, m, degrees].
  struct Orbit {
    Vec3 target;
    double azimuth = 0.0, elevation = 0.0, distance = 1.0, fov = 45.0;
    Projection projection = Projection::perspective;
    std::optional<CameraSettings> exact = {};  ///< until moved: what the angles would round
    friend bool operator==(const Orbit&, const Orbit&) = default;
  };
  static Orbit orbit_of(const CameraSettings& settings);
  static CameraSettings settings_of(const Orbit& orbit);
  /// To the point at (dx, dy) of the goal's view from the target [m].
  Vec3 across(double dx, double dy, double fov) const;
  /// The shown camera, turned by the multiple of 360° that brings it nearest to an azimuth [radians].
  void come_round(double azimuth);

  CameraSettings home_;
  Orbit goal_, shown_;
};

}  // namespace aspic::app
