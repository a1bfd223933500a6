#pragma once
// The mouse over the scene: moves the camera, finds the particle under it, works the hands.
#include <array>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "analysis/body_contact_forces.h"
#include "app/hands.h"
#include "app/scene_image.h"
#include "app/view.h"
#include "playback/playback_session.h"

namespace aspic::app {

/// The particle or ball under the mouse, or the one that is pulled.
struct Hovered {
  std::uint32_t particle = 0;  ///< of a ball its index among the model's
  Vec3 position, velocity;     ///< [m], [m/s] at the snapshot's step
  ParticleForce force;         ///< [N] then
  double mass = 0.0;           ///< [kg]
  bool pinned = false;
  bool ball = false;
  double radius = 0.0;    ///< of a ball [m]
  Vec3 angular_velocity;  ///< of a ball [rad/s]
  std::string contact;    ///< contacts of a ball, in words; empty: none
};

/// `on_panel`: a panel is under the mouse and takes the event.
class Pointer {
 public:
  /// The references must outlive it.
  Pointer(const PlaybackSession& simulation, View& view, SceneImage& image, Hands& hands)
      : simulation_(simulation), view_(view), image_(image), hands_(hands) {}

  // ---- events, as GLFW names them ----
  void press(int button, int modifiers, bool on_panel);
  void release(int button);
  void move(double x, double y);
  /// False if the event is the panels'.
  bool scroll(double notches, bool on_panel);
  /// A button that moves the camera is held, or a particle is pulled.
  bool drags() const { return drag_button_ >= 0 || simulation_.hand(); }
  /// What the mouse points at in its image; elsewhere, what the middle of the first image shows.
  Ray sight(bool on_panel) const;

  /// Once for each image, before it is drawn: finds what is under the mouse by what answers have come.
  void find_hovered();
  /// After it was shown: marks what was found and asks again. Error: of Renderer.
  Status mark_and_ask(bool on_panel);
  const std::optional<Hovered>& hovered() const { return hovered_; }
  /// The image and its answers are gone.
  void forget();

  /// Tells the time between clicks [s]; for tests, which do not wait.
  std::function<double()> clock = [] {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
  };

 private:
  /// What was asked about a place of an image.
  struct Question {
    double x = 0.0, y = 0.0;
    std::uint64_t image = 0, first = 0, last = 0;  // requests since the mouse came here
  };
  bool is_double_click();
  void describe(std::uint32_t particle);
  void describe_ball(std::uint32_t ball);
  void center_on(const Picked& picked);

  const PlaybackSession& simulation_;
  View& view_;
  SceneImage& image_;
  Hands& hands_;
  double x_ = -1.0, y_ = -1.0;  // of the mouse [window units]
  int drag_button_ = -1;
  bool drag_pans_ = false, center_wanted_ = false;
  double pressed_time_ = -1e9, pressed_x_ = 0.0, pressed_y_ = 0.0;  // the last press that was no double one
  std::optional<Hovered> hovered_;
  std::optional<Question> asked_;
  std::optional<SpringFinder> incident_;              // of the model with that number
  std::unique_ptr<BodyContactForces> body_contacts_;  // likewise
  std::uint64_t incident_model_ = 0;
};

}  // namespace aspic::app
