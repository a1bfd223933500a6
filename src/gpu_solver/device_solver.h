#pragma once
// What the explicit and the implicit solver share: the state's buffers, springs, balls, inputs, profiling.
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "gpu/pass.h"
#include "gpu/program.h"
#include "gpu_solver/ball_passes.h"
#include "gpu_solver/contact_buffers.h"
#include "gpu_solver/gpu_solver.h"
#include "gpu_solver/kernels.h"
#include "gpu_solver/layout.h"
#include "gpu_solver/lengths.h"
#include "gpu_solver/step_inputs.h"
#include "model/counts.h"

namespace aspic {

/// Readers of the data that is about to leave the solver.
inline constexpr gl::ReadBy anyone =
    gl::ReadBy::compute_pass | gl::ReadBy::vertex_draw | gl::ReadBy::read_back | gl::ReadBy::copy;

/// A pass over a fixed number of items.
struct ItemPass {
  gl::Pass pass;
  std::uint32_t items = 0;

  /// `buffers`: at most 8; those that are null or empty are left out, since the kernel reads none of them.
  void dispatch(std::span<const gl::Binding> buffers, gl::ReadBy readers) const;
  const gl::Program& program() const { return pass.program(); }
};

/// Every public call enters the solver's context (gpu/current.h).
class DeviceSolver : public GpuSolver {
 public:
  /// Makes everything and loads the initial state. Errors: those of make_gpu_solver.
  Status build(const GpuOptions& options);

  std::string_view backend() const final { return "gpu"; }
  std::string description() const final;
  Precision precision() const final { return Precision::single; }
  const Model& model() const final { return *model_; }
  std::uint64_t bytes() const final { return bytes_ + balls_.grown_bytes() + contact_.grown_bytes(); }
  DeviceState device_state() const final;
  gl::Context& context() const final { return context_; }
  ForcePath force_path() const final { return path_.path; }
  const gl::Arithmetic& arithmetic() const final { return arithmetic_; }
  const std::shared_ptr<const SpringBuffers>& spring_buffers() const final { return springs_; }

  Result<Advance> advance(std::uint64_t steps) final;
  void set_profiling(bool on) final;
  std::vector<gl::PassTime> pass_times() final;

 protected:
  /// `states`: buffers that a state takes turns in; `pass_names`: of the kinds of passes but the balls'.
  DeviceSolver(gl::Context& context, SharedModel model, const ForcePathRow& path, std::size_t states,
               std::vector<std::string> pass_names)
      : held_context_(context.weak_from_this().lock()),
        context_(context),
        model_(std::move(model)),
        path_(path),
        states_(states),
        pass_names_(std::move(pass_names)) {}

  /// Invocations per group of the kernels.
  virtual std::uint32_t group_size(const GpuOptions& options) const = 0;
  /// The solver's own buffers and passes, and the balls' passes.
  virtual Status build_passes(const KernelOptions& kernels, const GpuOptions& options) = 0;
  /// The state was loaded: its own control words follow.
  virtual void restart() = 0;

  /// Whether cubes or bodies of cells have no words here.
  bool takes_lattices() const {
    return springs_->kind == IncidentWords::beside_lattices || springs_->kind == IncidentWords::beside_cells;
  }
  gl::Binding lattices() const { return {BINDING_LATTICES, &springs_->lattices, gl::BufferKind::uniform}; }
  /// BINDING_INCIDENT_START of the solver's kernels.
  gl::Binding starts() const {
    return {BINDING_INCIDENT_START, lengths_.any() ? &lengths_.buffer() : &springs_->incident_start};
  }
  gl::Binding constants() const { return {BINDING_SIMULATION, &simulation_, gl::BufferKind::uniform}; }
  /// A program and the pass that runs it.
  Result<gl::Pass> pass(const KernelOptions& kernels, std::string_view path,
                        std::vector<gl::Binding> bindings);
  /// The same over `items`.
  Result<ItemPass> item_pass(const KernelOptions& kernels, std::string_view path,
                             std::vector<gl::Binding> bindings, std::uint32_t items);
  void mark(std::size_t kind) const {
    if (profiler_) profiler_->mark(kind);
  }
  /// Whether steps under way may be carried out after what the host says next.
  virtual bool repeats_steps() const { return balls_.any() || contact_.any(); }
  /// Queues steps and takes in what came of earlier ones, for advance().
  virtual Status take_steps(std::uint64_t steps) = 0;
  /// Waits for the queued steps, so that state and step number are those of good steps.
  virtual Status settle() { return {}; }
  /// The kernels count steps in 32 bits: before those are full, counting begins again. No step may be under
  /// way when it does, which is where counts_far().
  void keep_counting();
  bool counts_far() const { return steps_since_ > 0x7fffffffu; }
  /// The divergence a kernel's word means (Control and Solve in shaders/compute/layout.glsl), in the step
  /// after `steps` since the base step.
  Divergence divergence_from(std::uint32_t word, std::uint64_t steps) const;

  // Destroyed last. Null: the caller keeps the context alive.
  const std::shared_ptr<gl::Context> held_context_;
  gl::Context& context_;
  SharedModel model_;
  const ForcePathRow& path_;
  std::vector<gl::Buffer> states_;
  std::size_t current_ = 0;      // the state's buffer
  std::uint32_t ball_slot_ = 0;  // the slot of its balls
  std::shared_ptr<const SpringBuffers> springs_;
  PullBuffer pulls_;
  PoseBuffer poses_;      // of moving terrain
  LengthBuffer lengths_;  // of actuated springs
  BallPasses balls_;
  ContactBuffers contact_;  // of bodies
  gl::Buffer simulation_;

  std::uint64_t base_step_ = 0;    // step number of the loaded state
  std::uint32_t steps_since_ = 0;  // steps since then, which the kernels count in
  std::optional<Divergence> divergence_;
  bool fast_ = false;  // spring forces in fast arithmetic
  std::unique_ptr<gl::PassProfiler> profiler_;

 private:
  Status build_shared(const GpuOptions& options);
  void take(const ConstStateView& state, std::uint64_t step);
  Status take_state(const ConstStateView& view, std::uint64_t step) final;
  Result<std::uint64_t> give_state(const StateView& view) final;
  Status take_inputs(const Inputs& inputs) final;
  Status take_constants(SharedModel model, std::uint64_t step) final;
  void read(const StateView& view) const;
  Status hold_pins();

  std::vector<std::string> pass_names_;
  std::vector<std::shared_ptr<const gl::Program>> programs_;  // of the passes
  gl::Arithmetic arithmetic_;
  Inputs held_;                             // whose pins the state's weights have
  std::vector<std::uint32_t> moving_pins_;  // of the scene's pins those that move in the state
  bool pins_held_ = false;                  // those are inputs(), and none moves
  std::uint64_t bytes_ = 0;
};

/// What a kind of methods brings to the device. A new kind derives from DeviceSolver and is named in
/// device_method().
struct DeviceMethod {
  /// Called by make_gpu_solver; same contract. `path`: one that the method takes.
  Result<std::unique_ptr<GpuSolver>> (*make)(gl::Context& context, SharedModel model,
                                             const GpuOptions& options, const ForcePathRow& path);
  bool (*takes)(const ForcePathRow& path);  ///< all paths that `automatic` stands for, at least
  /// gpu_bytes() without what all kinds share.
  std::uint64_t (*bytes)(const ModelCounts& counts, Integrator integrator);
  std::uint64_t particle_bytes;  ///< of its largest array, for each particle
  bool cells;                    ///< kernels take cells by blocks; implicit Euler has no storage block free
};

/// Explicit methods, and scenes without particles: every stage one or two dispatches, no read-back inside a
/// step.
extern const DeviceMethod staged_method;
/// Implicit Euler, without a read-back inside a step (shaders/compute/implicit.glsl).
extern const DeviceMethod newton_method;

/// Without particles only balls are left, which fly by stages.
const DeviceMethod& device_method(Integrator integrator, std::uint64_t particles);

/// The words of a model's springs on this path.
IncidentWords incident_words(const Model& model, const ForcePathRow& path);

}  // namespace aspic
