#pragma once
// Every program of the image. Few of them are needed for one, so each is compiled when it is first used.
#include <array>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "aspic/scene.h"
#include "base/result.h"
#include "gpu/program.h"
#include "model/model.h"
#include "render/layout.h"

namespace aspic {

/// A program that is compiled when it is first used, or together with others from start() on.
class RenderProgram {
 public:
  /// Where programs are made, and the first error of those that could not be.
  struct Source {
    gl::Context& context;
    gl::ShaderLibrary library;
    Status refused = {};
    /// The error since this was last asked.
    Status take_refused() { return std::exchange(refused, Status()); }
  };

  RenderProgram() = default;
  RenderProgram(std::shared_ptr<Source> source, const gl::ProgramStages& stages,
                std::vector<gl::Define> defines = {})
      : source_(std::move(source)), stages_(stages), defines_(std::move(defines)) {}

  /// Begins to compile it.
  void start() const;
  /// An empty program where the device refuses it; Source::refused says why, and the next call tries again.
  const gl::Program& get() const;
  operator const gl::Program&() const { return get(); }
  std::uint32_t id() const { return get().id(); }
  template <class T>
  void set(int location, const T& value) const {
    get().set(location, value);
  }

 private:
  std::shared_ptr<Source> source_;
  gl::ProgramStages stages_;
  std::vector<gl::Define> defines_;
  mutable gl::SharedProgram program_;
  mutable bool ready_ = false;
};

struct RenderPrograms {
  std::shared_ptr<RenderProgram::Source> source;
  RenderProgram bounds, balls_turn, light_boxes, skin, mesh_skin, mesh_normals, quantity;  ///< kernels
  RenderProgram light_surface, light_particles, light_springs, light_balls;  ///< into light maps
  RenderProgram thickness, jelly_far, jelly, particles, springs, balls;      ///< bodies
  RenderProgram rods, sheet;                                                 ///< more of them
  std::array<RenderProgram, 2> plane, cut_plane;                             ///< flat ground: plain, shadowed
  std::array<RenderProgram, LIGHTS> shade;                                   ///< of flat ground
  RenderProgram solid, glass, reference_ground, sky;                         ///< other surroundings
  std::array<RenderProgram, 2> halve;                                        ///< of one sample, of several
  RenderProgram overlay;                                                     ///< text
  RenderProgram present, ghost;                                              ///< into a window

  /// Compiles nothing.
  static RenderPrograms create(gl::Context& context, const gl::ShaderLibrary& library);

  /// Begins to compile, all at once, what images of a model need, as far as the view tells. What it
  /// overlooks is compiled when it is used.
  void start(const Model& model, const ViewSettings& view, bool shadows) const;
};

}  // namespace aspic
