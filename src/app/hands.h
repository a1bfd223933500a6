#pragma once
// What the user does to bodies with the mouse: throws balls at them, pulls and pins their particles.
#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "app/messages.h"
#include "app/view.h"
#include "playback/playback_session.h"

namespace aspic::app {

class Hands {
 public:
  /// The references must outlive it.
  Hands(PlaybackSession& simulation, const View& view, Messages& messages)
      : simulation_(simulation), view_(view), messages_(messages) {}

  /// Why pulls and pins are not possible at present; nothing: they are.
  std::function<std::optional<std::string>()> refusal = {};
  double radius = 0.3;    ///< of a thrown ball [m], > 0
  double mass = 20.0;     ///< of a thrown ball [kg], > 0
  double speed = 15.0;    ///< of a thrown ball [m/s], ≥ 0
  double strength = 1.0;  ///< factor on the stiffness of a pull, > 0

  /// Throws a ball from the camera at the place (x, y) of the view [window units].
  void throw_ball(const Ray& sight);
  void throw_many();
  /// Removes all thrown balls.
  void clear_balls();
  void toggle_pin(std::uint32_t particle);

  /// A pull on a particle of the model, which moves with the mouse in the plane through `position` [m] that
  /// is square to the view.
  void begin_pull(std::uint32_t particle, const Vec3& position);
  /// The same on a ball.
  void begin_ball_pull(std::uint32_t ball, const Vec3& position);
  /// Says that there is no pinning of a ball.
  void refuse_pin() { messages_.info("Particles can be pinned, balls cannot."); }
  /// To the place (x, y) of the view [window units]; nothing without a pull.
  void move_pull(double x, double y);
  void end_pull() { simulation_.set_hand(std::nullopt); }

 private:
  bool refused();
  BallSettings thrown_ball(const Ray& sight) const;
  void take_hold(Pull pull, double held_mass, double most);

  PlaybackSession& simulation_;
  const View& view_;
  Messages& messages_;
  std::uint32_t thrown_ = 0;  // by throw_many(): each ball flies its own way
  Vec3 pull_plane_;           // a point of the plane in which the anchor moves [m]
};

}  // namespace aspic::app
