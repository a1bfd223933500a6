#pragma once
// The body or ball that a camera keeps in view (the key view.follow), and where it is.
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "aspic/scene.h"
#include "aspic/state.h"
#include "model/model.h"

namespace aspic {

/// What is followed: a body of the model or a ball, by index.
struct Followed {
  bool ball = false;
  std::uint32_t index = 0;
  friend bool operator==(const Followed&, const Followed&) = default;
};

/// `cube[0]` (or `cube`), `goal-net[1]`, `ball[2]`: an element of a list of bodies, or any ball, those of
/// launchers counted after those of [[ball]]; or a body's own name. Nothing if the scene has none of that
/// name.
std::optional<Followed> find_followed(const ModelSettings& settings, std::string_view name);

/// Every body by its place in its list, and of balls the first `most_balls`.
std::vector<std::string> followable(const ModelSettings& settings, std::uint64_t most_balls);

/// The name that what is followed has once an element of a list of bodies or balls is removed; nothing if
/// that was it.
std::optional<std::string> followed_without(const std::string& name, std::string_view key, std::size_t index);

/// The name of the body that a particle belongs to, or of a ball; the model is that of the settings.
std::string name_of_body(const ModelSettings& settings, const Model& model, std::uint32_t particle);
std::string name_of_ball(std::uint32_t ball);

/// The mean of a body's particles, or a ball's center [m]. The followed body must be in the model, the state
/// of it.
Vec3 place_of(const Model& model, const State& state, const Followed& followed);

/// How far a camera moves along with the body that a scene's view follows.
class Following {
 public:
  /// Nothing is followed.
  Following() = default;
  /// What the scene's view names, from the start of the scene in numbers of that precision; nothing if the
  /// model has no such body or ball.
  Following(const Scene& scene, const Model& model, Precision precision);
  bool any() const { return what_.has_value(); }
  /// From the start to a state of the model [m]; zero where nothing is followed.
  Vec3 offset(const Model& model, const State& state) const {
    return what_ ? place_of(model, state, *what_) - start_ : Vec3{};
  }

 private:
  std::optional<Followed> what_;
  Vec3 start_;  // [m]
};

/// A camera that was moved along.
inline CameraSettings moved(CameraSettings camera, const Vec3& by) {
  camera.position = camera.position + by;
  camera.target = camera.target + by;
  return camera;
}

}  // namespace aspic
