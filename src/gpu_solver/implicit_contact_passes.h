#pragma once
// Contact between bodies in implicit Euler: passes before residuals and before products with the matrix
// (shaders/compute/implicit_contact_*.comp).
#include <array>
#include <memory>
#include <optional>

#include "gpu/pass.h"
#include "gpu_solver/contact_buffers.h"
#include "gpu_solver/kernels.h"

namespace aspic {

class ImplicitContactPasses {
 public:
  /// Bound to every pass that asks for it.
  struct Surroundings {
    gl::Binding constants = {}, solve = {}, state_a = {}, state_b = {}, trial = {}, search = {};
  };

  /// `bodies` must outlive it.
  explicit ImplicitContactPasses(const ContactBuffers& bodies) : bodies_(bodies) {}

  /// Makes programs; nothing at all for a model whose bodies do not touch. Errors as make_gpu_solver.
  Status build(const KernelOptions& kernels, const Surroundings& surroundings);

  /// Queues the look whether lists still hold, before a step begins.
  void queue_start() const { run(moved, bodies_.place_count(), bodies_.most()); }
  /// Queues what comes before a residual: at the start of a solve contacts are found. `time`: of the step's
  /// start, since the initial state [s].
  void queue_forces(float time) const;
  /// Queues the product of the contacts' matrix with the direction.
  void queue_product() const;

 private:
  enum Kernel : std::size_t {
    moved,
    find,
    normal_forces,
    friction,
    react,
    gather,
    multiply,
    product,
    kernel_count
  };
  void run(Kernel kernel, std::uint32_t items, float number = 0.0f) const;

  const ContactBuffers& bodies_;
  std::array<std::shared_ptr<const gl::Program>, kernel_count> programs_;
  std::array<std::optional<gl::Pass>, kernel_count> passes_;
};

}  // namespace aspic
