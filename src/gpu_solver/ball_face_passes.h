#pragma once
// Balls and faces of bodies on the device (shaders/compute/ball_face_blocks.glsl): passes that BallPasses
// queues between its own.
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "gpu/pass.h"
#include "gpu/pass_profiler.h"
#include "gpu/program.h"
#include "gpu_solver/kernels.h"
#include "gpu_solver/layout.h"
#include "model/model.h"

namespace aspic {

/// Bytes of device memory that they take for a model; 0 where its balls meet no faces.
std::uint64_t ball_face_bytes(const Model& model);

class BallFacePasses {
 public:
  /// Makes buffers and passes; nothing at all for a model whose balls meet no faces. `bindings`: of every
  /// pass. Errors as make_gpu_solver.
  Status build(gl::Context& context, const Model& model, const KernelOptions& kernels,
               const std::vector<gl::Binding>& bindings);
  bool any() const { return block_count_ > 0; }

  /// Explicit methods: `step` and `parity` as in BallPasses::queue().
  void begin_step(std::uint32_t step, std::uint32_t parity) const;
  /// After flight: which faces balls touch.
  void queue_find(std::span<const gl::Binding> states) const;
  /// After all phases of other pairs.
  void queue_meet(std::span<const gl::Binding> states, gl::ReadBy last) const;

  /// As BallPasses.
  static std::vector<std::string> pass_names();
  void set_profiler(gl::PassProfiler* profiler, std::size_t first) {
    profiler_ = profiler;
    first_kind_ = first;
  }

 private:
  enum Kernel : std::size_t { boxes, find, tally, impulse, gather, kernel_count };
  void dispatch(Kernel kernel, std::uint32_t items, std::span<const gl::Binding> states,
                gl::ReadBy readers = gl::ReadBy::compute_pass) const;

  std::uint32_t block_count_ = 0, pair_count_ = 0;
  std::uint32_t body_count_ = 0;  // balls and particles
  gl::Buffer faces_, boxes_, pairs_, counts_;
  std::array<std::shared_ptr<const gl::Program>, kernel_count> programs_;
  std::array<std::optional<gl::Pass>, kernel_count> passes_;
  gl::PassProfiler* profiler_ = nullptr;
  std::size_t first_kind_ = 0;
};

}  // namespace aspic
