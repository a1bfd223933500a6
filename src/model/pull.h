#pragma once
// Pulling a particle or a ball: an input of the model that may change from step to step, the same on every
// backend.
#include <cstdint>
#include <optional>

#include "base/result.h"
#include "model/model.h"
#include "model/state.h"
#include "model/vec3.h"

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

/// The pull as a solver of that precision takes it: rounded, −0 read as +0. Errors (usage): the model has no
/// such particle or ball, a number is not finite (or too large for the precision), stiffness or damping is
/// negative.
Result<std::optional<Pull>> rounded_pull(const Model& model, const std::optional<Pull>& pull,
                                         Precision precision);

}  // namespace aspic
