#pragma once
// What is wrong with a scene, whatever it was read from.
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "aspic/scene.h"
#include "scene/parameters.h"

namespace aspic {

/// What is wrong with a scene, and where.
struct SceneComplaint : Complaint {
  std::string path;        ///< the key to blame, `cube[1].shear.stiffness`; empty: the scene in general
  std::string other = {};  ///< another key that the complaint depends on; empty: none
  bool of_key = false;     ///< the key has no place there, whatever its value
};

/// Checks every value and conditions of the complete scene: geometry of another shape, pinned indices,
/// boxes, the camera, a scene in which nothing moves, more than 32-bit indices or `memory_bytes` (absent: any
/// number) hold. Empty if the scene is legal.
std::vector<SceneComplaint> check_scene(const Scene& scene,
                                        std::optional<std::uint64_t> memory_bytes = std::nullopt);

}  // namespace aspic
