#pragma once
// The faces that balls meet (docs/balls.md, "Faces"): those of bodies with a surface. Made once, from a
// model.
#include <array>
#include <cstdint>
#include <vector>

#include "model/model.h"

namespace aspic {

/// The triangles of a body's surface, in the order in which contact between bodies counts them.
struct FacesOfBody {
  std::uint32_t first_triangle = 0, triangle_count = 0;
  bool closed = true;  ///< has an inside
};

struct BallFaces {
  std::vector<FacesOfBody> bodies;                      ///< in the order of the model's
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< particles, counterclockwise seen from outside
};

/// Triangles in a row that are passed over as one where they are far.
inline constexpr std::uint32_t face_block = 64;

/// Whether balls meet faces: where bodies touch, but for the course model, whose formulas know particles
/// alone.
bool balls_meet_faces(const Model& model);

/// None where they do not.
BallFaces ball_faces(const Model& model);

}  // namespace aspic
