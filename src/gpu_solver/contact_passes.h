#pragma once
// Contact between bodies in a stage of an explicit method: the passes between the forces of springs and the
// ground's (shaders/compute/terms/body_contact.glsl).
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "gpu/pass.h"
#include "gpu/program.h"
#include "gpu_solver/contact_buffers.h"
#include "gpu_solver/kernels.h"

namespace aspic {

class ContactPasses {
 public:
  /// Bound to every pass.
  struct Surroundings {
    gl::Binding constants = {}, control = {};
  };
  /// The states of a stage.
  struct States {
    const gl::Buffer *start = nullptr, *stage = nullptr, *out = nullptr;
  };

  /// `bodies` must outlive it.
  explicit ContactPasses(const ContactBuffers& bodies) : bodies_(bodies) {}

  /// Makes programs and what stays; nothing at all for a model whose bodies do not touch. Errors as
  /// make_gpu_solver.
  Status build(gl::Context& context, const KernelOptions& kernels, const Surroundings& surroundings);

  /// Queues the look whether lists still hold at the start of a step.
  void queue_start(const gl::Buffer& start, std::uint32_t step) const;
  /// Queues the contacts of a stage, before the forces of springs.
  void queue_find(const States& states, std::uint32_t step, float time) const;
  /// Queues normal forces and friction on these forces.
  void queue_act(const States& states, std::uint32_t step) const;

 private:
  enum Kernel : std::size_t { moved, find, normal_forces, friction, friction_sums, kernel_count };
  void run(Kernel kernel, std::uint32_t items, std::uint32_t step, std::span<const gl::Binding> states) const;

  const ContactBuffers& bodies_;
  gl::Buffer values_;
  std::array<std::shared_ptr<const gl::Program>, kernel_count> programs_;
  std::array<std::optional<gl::Pass>, kernel_count> passes_;
};

}  // namespace aspic
