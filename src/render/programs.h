#pragma once
// Every program of the picture, compiled once.
#include "base/result.h"
#include "gpu/program.h"
#include "render/layout.h"

namespace aspic {

struct RenderPrograms {
  gl::Program bounds, balls_turn, light_boxes, skin, mesh_skin, mesh_normals, quantity;  ///< kernels
  gl::Program light_surface, light_particles, light_springs, light_balls;                ///< into light maps
  gl::Program thickness, jelly_far, jelly, particles, springs, balls;                    ///< bodies
  gl::Program rods, sheet;                                                               ///< more of them
  std::array<gl::Program, 2> plane, cut_plane;  ///< flat ground: plain, shadowed
  std::array<gl::Program, LIGHTS> shade;        ///< of flat ground
  gl::Program solid, glass, sky;                ///< other surroundings
  std::array<gl::Program, 2> halve;             ///< of one sample, of several
  gl::Program present, ghost;                   ///< into a window

  /// Errors: those of Program::compute and Program::graphics.
  static Result<RenderPrograms> create(gl::Context& context, const gl::ShaderLibrary& library);
};

}  // namespace aspic
