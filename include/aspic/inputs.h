#pragma once
// Pulling a particle or a ball: an input of the model that may change from step to step, the same on every
// backend.
#include <cstdint>

#include "aspic/vec.h"

namespace aspic {

/// A damped spring of rest length 0 from a particle to a fixed anchor, as a hand pulls at the jelly. Its
/// force is that of a spring (docs/physics.md, section 1) whose other end rests at the anchor,
///   e = x − anchor,  f = −[k·|e| + c(v·e)/|e|]·e/|e|,
/// nothing where e = 0, and is added to the particle's sum after its springs and before contact. On a ball it
/// acts at the centre, is added to gravity, and is that of the step's start throughout the step, since balls
/// fly under a constant force (docs/balls.md).
struct Pull {
  std::uint32_t particle = 0;  ///< global index, of a ball where `ball`; a pinned particle feels it and stays
  Vec3 anchor;                 ///< [m]
  double stiffness = 0.0;      ///< k [N/m], ≥ 0
  double damping = 0.0;        ///< c [N·s/m], ≥ 0
  bool ball = false;           ///< pulls a ball instead of a particle

  friend bool operator==(const Pull&, const Pull&) = default;
};

}  // namespace aspic
