#pragma once
// Where the scene is seen from, and where in the window.
#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "app/camera_control.h"
#include "app/gui.h"
#include "app/kept_state.h"
#include "app/messages.h"
#include "aspic/scene.h"
#include "aspic/state.h"
#include "model/model.h"
#include "render/camera.h"

namespace aspic::app {

/// Where another run is shown: as large as the window's own, with the same camera, moved along by as much as
/// what it follows has moved in that run [m].
struct OtherImage {
  Box box;
  Vec3 offset;
};

struct View {
  explicit View(const CameraSettings& home) : camera(home) {}

  CameraControl camera;
  Box box;                         ///< where the scene is drawn [window units]
  Box whole;                       ///< the same with all runs that are side by side
  std::vector<OtherImage> others;  ///< of the runs compared with it
  double pixels_per_unit = 1.0;    ///< of the framebuffer
  double text_scale = 1.0;         ///< of the panels, see Gui::scale()
  std::vector<KeptCamera> kept;    ///< of scenes seen before

  bool recalled = false;  ///< a saved camera was restored and not drawn yet

  /// The first image's camera is moved along by so much [m] with what the scene says, or with nothing.
  /// Where that is something else than before, the image stays as it is.
  void follow(const std::optional<std::string>& what, const Vec3& offset);
  /// The camera is another one: what is followed next changes nothing about it.
  void forget_followed() { followed_.reset(); }
  /// How far that camera was moved along [m].
  const Vec3& offset() const { return offset_; }

  double width() const { return std::max(box.right - box.left, 1.0); }
  double height() const { return std::max(box.bottom - box.top, 1.0); }
  /// A place in the window as one in `box`, from its left and top, where another run's image has the same
  /// place.
  std::array<double, 2> within(double x, double y) const;
  /// What is there, seen from the camera of that image.
  Ray sight(double x, double y) const;
  /// The camera that is shown. A narrow view shows as much from side to side as one of 4 : 3.
  CameraSettings seen() const { return seen(offset_); }
  /// The same of an image whose camera moved along by another way [m].
  CameraSettings seen(const Vec3& offset) const;
  /// Whether any particle or ball of a state is in the image.
  bool sees_bodies(const State& state) const;
  /// The camera now, of an image with a pixel for each window unit.
  Camera lens() const { return lens(offset_); }
  /// Comes nearer or backs off until all bodies of a state of the model are in the image.
  void frame_bodies(const Model& model, const State& state);
  /// Keeps the camera of a scene (file or built-in name) if it was moved; goes back to the one kept, if any.
  void keep_camera(const std::string& source) { kept = kept_with(source); }
  void recall_camera(const std::string& source);
  /// `kept` with the camera of the scene that is open.
  std::vector<KeptCamera> kept_with(const std::string& source) const;

 private:
  Camera lens(const Vec3& offset) const;
  const OtherImage* other_at(double x, double y) const;

  std::optional<std::optional<std::string>> followed_;  // absent: not known yet
  Vec3 offset_;                                         // [m]
};

/// The camera as text on the clipboard, and back. `scene` is any that is valid.
void copy_camera(const View& view, const WindowServices& services, Messages& messages);
void paste_camera(View& view, const Scene& scene, const WindowServices& services, Messages& messages);

}  // namespace aspic::app
