#pragma once
// The physics of a scene as text that needs no TOML to be read: a line PATH=VALUE for each key, by the
// parameter table, so that a new key needs no change here.
#include <string>
#include <string_view>

#include "aspic/scene.h"
#include "base/result.h"

namespace aspic {

/// Every key that has a value in the scene and a say in its motion, in the order of the table; numbers so
/// that they are read back as the same ones. Each line ends with a line feed.
std::string to_key_lines(const Scene& scene);

/// The scene with the values of the lines; a list gets one more element where a line names the index after
/// its last. Errors (scene_rejected): a line that is none, an unknown key, a value of another type, and what
/// check_scene() says of the result, in a sentence.
Result<Scene> with_key_lines(Scene scene, std::string_view lines);

}  // namespace aspic
