#pragma once
// Where the scene is seen from, and where in the window.
#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "app/camera_control.h"
#include "app/gui.h"
#include "app/kept_state.h"
#include "app/messages.h"
#include "model/model.h"
#include "model/state.h"
#include "render/camera.h"
#include "scene/scene.h"

namespace aspic::app {

struct View {
  explicit View(const CameraSettings& home) : camera(home) {}

  CameraControl camera;
  Box box;                       ///< where the scene is drawn [window units]
  Box whole;                     ///< the same with all runs that are side by side
  std::vector<Box> others;       ///< of the runs beside it, each as large as `box`
  double pixels_per_unit = 1.0;  ///< of the framebuffer
  double text_scale = 1.0;       ///< of the panels, see Gui::scale()
  std::vector<KeptCamera> kept;  ///< of scenes seen before

  bool recalled = false;  ///< a camera was that nobody has looked through since

  double width() const { return std::max(box.right - box.left, 1.0); }
  double height() const { return std::max(box.bottom - box.top, 1.0); }
  /// A place in the window as one in `box`, from its left and top, where another run's picture has the same
  /// place.
  std::array<double, 2> within(double x, double y) const;
  /// The camera that is shown. A narrow view shows as much from side to side as one of 4 : 3.
  CameraSettings seen() const;
  /// Whether any particle or ball of a state is in the picture.
  bool sees_bodies(const State& state) const;
  /// The camera now, of a picture with a pixel for each window unit.
  Camera lens() const;
  /// Comes nearer or backs off until all bodies of a state of the model are in the picture.
  void frame_bodies(const Model& model, const State& state);
  /// Keeps the camera of a scene (file or built-in name) if it was moved; goes back to the one kept, if any.
  void keep_camera(const std::string& source) { kept = kept_with(source); }
  void recall_camera(const std::string& source);
  /// `kept` with the camera of the scene that is open.
  std::vector<KeptCamera> kept_with(const std::string& source) const;
};

/// The camera as text on the clipboard, and back. `scene` is any that is valid.
void copy_camera(const View& view, const WindowServices& services, Messages& messages);
void paste_camera(View& view, const Scene& scene, const WindowServices& services, Messages& messages);

}  // namespace aspic::app
