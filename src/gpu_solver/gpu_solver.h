#pragma once
// The compute solver: passes over shader storage buffers, the same bits as the reference in single precision.
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "aspic/solver.h"
#include "device/device_state.h"
#include "gpu/canary.h"
#include "gpu/context.h"
#include "gpu/pass_profiler.h"
#include "gpu_solver/force_paths.h"

namespace aspic {

/// How balls find whom they touch; either way gives the same bits.
enum class BallSearch {
  automatic,  ///< all pairs for a handful, the grid for many
  all_pairs,  ///< every body is tried
  grid        ///< a uniform grid, hashed
};

class GpuSolver;

struct GpuOptions {
  ForcePath force_path = ForcePath::automatic;
  /// Invocations per work group, 1…1024; 0: by device (group_size.h). Never affects the bits.
  std::uint32_t group_size = 0;
  /// Particles that an invocation of the path lattice takes, 1 or 4; 0: 4 on software rasterizers, which then
  /// read a neighbor once for several, and 1 on hardware, whose lanes then read neighboring particles.
  /// Never affects the bits.
  std::uint32_t lattice_run = 0;
  /// Stages of explicit methods in two passes, forces and the rest, as where bodies touch: scenes on other
  /// terrain then share the kernels of forces, which drivers compile for seconds, and steps are slower. A
  /// state must fit into a storage block. Never affects the bits.
  bool split_stages = false;
  /// fast: spring forces of explicit methods with reciprocal roots and fused operations, as the device likes.
  Arithmetic spring_arithmetic = Arithmetic::exact;
  BallSearch ball_search = BallSearch::automatic;
  /// Files here go before the embedded shaders; empty: embedded alone.
  std::filesystem::path shader_directory;
  /// Further definitions for the kernels. MAX_ROUNDS and MAX_WALK lower the bounds of loops
  /// (shaders/shared/layout.glsl), so that a test reaches them; never affects the bits of a step that ends.
  std::vector<gl::Define> defines;
  /// How to compile for this device's arithmetic; absent: the canary is asked first.
  std::optional<gl::Arithmetic> arithmetic;
  /// A solver to share with: where both models have the same springs, its buffers of them serve both. It
  /// needs to live no longer than the call; null: none.
  const GpuSolver* share_springs_of = nullptr;
};

/// A gpu solver with a look at its buffers, for drawing without a copy.
class GpuSolver : public Solver {
 public:
  /// The current state where it lies. Valid until the solver steps, loads or goes.
  virtual DeviceState device_state() const = 0;
  /// Where it works.
  virtual gl::Context& context() const = 0;
  /// The path in use, never automatic.
  virtual ForcePath force_path() const = 0;
  /// What the canary found on this device, and how the kernels were compiled for it.
  virtual const gl::Arithmetic& arithmetic() const = 0;
  /// From now on advance() may return before the device is done, for a window that must not wait: then a
  /// divergence, a lost device and the end of the steps before it come out of the next advance(), at most two
  /// queues late, and device_state() is what will be there; of implicit-euler, where a solve takes more
  /// rounds than were queued for it, it may be a step or two before until the next call. state() waits, and
  /// its step is that of a good state; so does set_inputs() of other pulls with balls or implicit-euler,
  /// and the first advance() with other pins. Off at first.
  virtual void set_late(bool on) = 0;
  /// Measures device time by pass from now on, or no longer. Off at first; never affects the bits. One step
  /// in each queue of an advance() is measured; implicit-euler waits for the device once more
  /// then.
  virtual void set_profiling(bool on) = 0;
  /// The passes of a step in their order, means over the last 64 steps that were measured: their sum is the
  /// device time of a step. Empty while nothing is measured yet. Never waits for the device.
  virtual std::vector<gl::PassTime> pass_times() = 0;
  /// What another solver may share (GpuOptions::share_springs_of).
  virtual const std::shared_ptr<const SpringBuffers>& spring_buffers() const = 0;
};

/// A gpu solver at the model's initial state. It keeps the context alive that a std::shared_ptr holds; any
/// other must outlive it. This and every call of the solver enter the context (gpu/current.h), so that any
/// number of solvers take turns on a thread; a call from another thread than the one that the context is in
/// use on is an error. Errors: scene_rejected (not built yet, or larger than the device's buffers or index
/// words, or the device has no memory left: the sentence gives the figures), no_device (the driver refuses a
/// kernel, or the context is lost), io (a shader file cannot be read).
Result<std::unique_ptr<GpuSolver>> make_gpu_solver(gl::Context& context, SharedModel model,
                                                   const GpuOptions& options = {});
/// With a model of its own: a copy, or what is moved here.
inline Result<std::unique_ptr<GpuSolver>> make_gpu_solver(gl::Context& context, Model model,
                                                          const GpuOptions& options = {}) {
  return make_gpu_solver(context, shared(std::move(model)), options);
}

/// Bytes of device memory a solver of the model would hold; of a path that its integrator does not take, as
/// automatic.
std::uint64_t gpu_bytes(const Model& model, ForcePath path);

}  // namespace aspic
