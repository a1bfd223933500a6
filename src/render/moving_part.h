#pragma once
// Where on an image anything can be that a state moves: the rest is what it was before.
#include <glm/common.hpp>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "device/layout.h"
#include "gpu/texture.h"
#include "model/model.h"
#include "model/shapes/shape.h"
#include "render/layout.h"
#include "render/mesh.h"

namespace aspic {

/// A box of space [m]; empty at first.
struct Extent {
  glm::dvec3 lower = glm::dvec3(1e300), upper = glm::dvec3(-1e300);
  bool empty() const { return lower.x > upper.x; }
  void add(const glm::dvec3& point) {
    lower = glm::min(lower, point);
    upper = glm::max(upper, point);
  }
  Extent moved(const glm::dvec3& by) const { return {lower + by, upper + by}; }
};
Extent extent_of(const Mesh& mesh);

/// What of an image changes with the state.
struct MovingThings {
  std::span<const layout::Particle> particles;
  std::span<const layout::Ball> balls;  ///< those without inverse mass are not drawn
  double particle_radius = 0.0;         ///< around each particle that something may be drawn [m]
  double margin = 0.0;                  ///< and on the image [pixels]
  std::vector<Extent> extents;          ///< other things that may look otherwise
  std::vector<FlatPart> shadowed;       ///< planes that things throw shadows on
};

/// Boxes of the image of `frame` outside of which nothing of them is; no two overlap much. The whole
/// image where that cannot be told.
std::vector<gl::PixelBox> moving_part(const render_layout::Frame& frame, const MovingThings& things);

}  // namespace aspic
