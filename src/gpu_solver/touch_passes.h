#pragma once
// Contact between bodies on the device: the passes of a stage between the forces of springs and the ground's
// (shaders/compute/touch.glsl), and the lists they walk over, which the host makes again when bodies have
// moved.
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "gpu/pass.h"
#include "gpu/pass_profiler.h"
#include "gpu/program.h"
#include "gpu_solver/kernels.h"
#include "gpu_solver/layout.h"
#include "gpu_solver/touch_lists.h"

namespace aspic {

class TouchPasses {
 public:
  /// Bound to every pass.
  struct Surroundings {
    gl::Binding constants = {}, control = {};
  };
  /// The states of a stage.
  struct States {
    const gl::Buffer *start = nullptr, *stage = nullptr, *out = nullptr, *sums = nullptr;
  };

  /// Makes programs and what stays; nothing at all for a model whose bodies do not touch. `finish`: what the
  /// kernel that ends a stage reads in addition. Errors as make_gpu_solver.
  Status build(gl::Context& context, const Model& model, const KernelOptions& kernels,
               const KernelOptions& stage_kernels, const Surroundings& surroundings,
               std::vector<gl::Binding> finish);

  bool any() const { return lists_ != nullptr; }
  /// Whether something may touch while the lists hold, so that stages need the passes.
  bool acts() const { return encounter_count_ > 0; }

  /// The state, or what belongs to it, is another one: refresh() before the next step.
  void forget() { fresh_ = false; }
  bool fresh() const { return fresh_ || !any(); }
  void set_model(const Model& model);
  /// Makes the lists for the state in a buffer. Errors as TouchLists::make() and Buffer::create().
  Status refresh(const gl::Buffer& state);
  /// After how many steps lists may not hold any more, by the particles' speeds when they were made: so many
  /// are worth being queued.
  std::uint64_t patience() const { return patience_; }
  /// That many have passed.
  void held(std::uint64_t steps);

  /// Queues the look whether lists still hold at the start of a step.
  void queue_start(const gl::Buffer& start, std::uint32_t step) const;
  /// Queues the contacts of a stage, before the forces of springs.
  void queue_find(const States& states, std::uint32_t step, float time) const;
  /// Queues pushes and friction on these forces, then the rest of the stage.
  void queue_act(const States& states, std::uint32_t step, std::uint32_t stage, gl::ReadBy last) const;

  /// Bytes held beyond those after build().
  std::uint64_t grown_bytes() const;

 private:
  enum Kernel : std::size_t { moved, find, push, rub, drag, finish, kernel_count };
  Status fit(gl::Buffer& buffer, const char* name, std::uint64_t bytes);
  void run(Kernel kernel, std::uint32_t items, std::uint32_t step, std::span<const gl::Binding> states,
           gl::ReadBy readers = gl::ReadBy::compute_pass) const;

  gl::Context* context_ = nullptr;
  const Model* model_ = nullptr;
  std::unique_ptr<TouchLists> lists_;
  bool fresh_ = false;
  std::uint32_t encounter_count_ = 0, listed_count_ = 0, place_count_ = 0, particle_count_ = 0;
  std::uint64_t patience_ = 1;
  gl::Buffer triangles_, encounters_, words_, records_, listed_, values_, places_;
  std::array<std::shared_ptr<const gl::Program>, kernel_count> programs_;
  std::array<std::optional<gl::Pass>, kernel_count> passes_;
};

}  // namespace aspic
