#include "gpu_solver/gpu_solver.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <vector>

#include "gpu/pass.h"
#include "gpu/program_cache.h"
#include "gpu_solver/ball_passes.h"
#include "gpu_solver/implicit_solver.h"
#include "gpu_solver/pose_buffer.h"
#include "gpu_solver/pull_buffer.h"
#include "gpu_solver/simulation_block.h"
#include "gpu_solver/spring_buffers.h"
#include "gpu_solver/support.h"
#include "model/integrator.h"

namespace aspic {
namespace {

using gl::Binding;
using gl::Buffer;
using gl::Reader;

/// Steps queued between two looks at the control words: enough to hide the wait, few enough to answer Ctrl-C.
constexpr std::uint64_t steps_per_look = 256;
/// Readers of a state that is about to leave the solver.
constexpr Reader anyone = Reader::compute_pass | Reader::vertex_draw | Reader::read_back | Reader::copy;

/// Whether the method's sums outlive a stage, so that memory must hold them.
bool keeps_sums(const StagedMethod& method) {
  return std::any_of(method.stages.begin(), method.stages.end() - 1,
                     [](const Stage& s) { return s.weight != 0.0; });
}

/// Backward Euler without springs is symplectic Euler.
const StagedMethod* method_of(Integrator integrator) {
  return staged_method(integrator == Integrator::implicit_euler ? Integrator::symplectic_euler : integrator);
}

class ComputeSolver final : public GpuSolver {
 public:
  ComputeSolver(gl::Context& context, const Model& model, ForcePath path)
      : context_(context), model_(model), path_(path) {}

  Status build(const GpuOptions& options);

  std::string_view backend() const override { return "gpu"; }
  std::string description() const override {
    return fmt::format("gpu, {}, force path {}, single precision", context_.info().renderer, name_of(path_));
  }
  Precision precision() const override { return Precision::single; }
  const Model& model() const override { return model_; }
  std::uint64_t bytes() const override { return bytes_ + balls_.grown_bytes(); }
  const Buffer& particles() const override { return states_[current_]; }
  const Buffer& balls() const override { return balls_.buffer(); }
  std::uint32_t first_ball() const override { return ball_parity_ * model_.ball_count(); }
  ForcePath force_path() const override { return path_; }
  const gl::Arithmetic& arithmetic() const override { return arithmetic_; }
  const std::shared_ptr<const SpringBuffers>& spring_buffers() const override { return springs_; }

  Status load(const State& state) override {
    const Status taken = take(state);
    return taken ? check_device(context_) : taken;
  }
  Status set_pull(const std::optional<Pull>& pull) override { return pull_.set(model_, pull); }
  Result<std::optional<Divergence>> advance(std::uint64_t steps) override;
  Result<State> state() override;
  void set_profiling(bool on) override;
  std::vector<gl::PassTime> pass_times() override {
    return profiler_ ? profiler_->times() : std::vector<gl::PassTime>();
  }

 private:
  /// Kinds of passes, for the profiler; the balls' follow.
  enum Kind : std::size_t { springs_kind, particles_kind, ball_kinds };
  Status take(const State& state);
  Status build_buffers(const GpuOptions& options);
  Status build_passes(const GpuOptions& options);
  void queue_step(std::uint32_t step_index, bool last_of_queue);
  void mark(Kind kind) {
    if (profiler_) profiler_->mark(kind);
  }
  void reset_control();
  Result<layout::Control> read_control();

  gl::Context& context_;
  const Model& model_;
  const ForcePath path_;
  std::uint32_t stages_ = 0;
  std::uint64_t bytes_ = 0;

  // The step's start, its end, and a place for stages in between; the roles rotate with every step.
  std::array<Buffer, 3> states_;
  std::size_t current_ = 0;
  Buffer sums_, simulation_, control_, forces_;
  std::shared_ptr<const SpringBuffers> springs_;
  PullBuffer pull_;
  PoseBuffer poses_;
  gl::Arithmetic arithmetic_;
  std::shared_ptr<const gl::Program> force_program_, particle_program_;
  BallPasses balls_;
  std::uint32_t ball_parity_ = 0;  // slot of the balls' current state
  std::vector<gl::Pass> passes_;   // one per stage: particles, preceded on the per-spring path by springs
  std::unique_ptr<gl::PassProfiler> profiler_;

  std::uint64_t base_step_ = 0;    // step number of the loaded state
  std::uint32_t steps_since_ = 0;  // steps since: what the kernels count in
  std::optional<Divergence> divergence_;
};

Status ComputeSolver::build(const GpuOptions& options) {
  const std::uint64_t held_before = context_.bytes_held();
  if (const Status made = build_buffers(options); !made) return made;
  if (const Status made = build_passes(options); !made) return made;
  bytes_ = context_.bytes_held() - held_before;
  if (springs_.use_count() > 1) bytes_ += springs_->bytes();  // held before, by the solver it shares with
  if (const Status loaded = take(initial_state(model_, Precision::single)); !loaded) return loaded;
  return check_device(context_, ErrorCode::scene_rejected);
}

Status ComputeSolver::build_buffers(const GpuOptions& options) {
  const StagedMethod* method = method_of(model_.simulation.integrator);
  auto block = simulation_block(model_);
  if (!block) return block.error();
  stages_ = static_cast<std::uint32_t>(method->stages.size());

  const std::uint64_t state_bytes = std::uint64_t{model_.particle_count()} * sizeof(layout::Particle);
  for (Buffer& state : states_)
    ASPIC_ASSIGN_OR_RETURN(state, Buffer::create(context_, "particle state", state_bytes));
  ASPIC_ASSIGN_OR_RETURN(sums_,
                         Buffer::create(context_, "stage sums", keeps_sums(*method) ? state_bytes : 0));
  ASPIC_ASSIGN_OR_RETURN(
      simulation_, Buffer::of(context_, "simulation constants",
                              std::span<const layout::Simulation>(&*block, 1), gl::BufferKind::uniform));
  ASPIC_ASSIGN_OR_RETURN(control_, Buffer::create(context_, "control words", sizeof(layout::Control)));
  if (const Status made = pull_.build(context_); !made) return made;
  if (const Status made = poses_.build(context_, model_); !made) return made;

  ASPIC_ASSIGN_OR_RETURN(springs_, aspic::spring_buffers(context_, model_, path_, options.like));
  if (path_ == ForcePath::per_spring) {
    ASPIC_ASSIGN_OR_RETURN(
        forces_, Buffer::create(context_, "spring forces", model_.springs.size() * sizeof(layout::vec4)));
  }
  return {};
}

Status ComputeSolver::build_passes(const GpuOptions& options) {
  const gl::ShaderLibrary library(options.shader_directory);
  KernelOptions kernels;
  ASPIC_ASSIGN_OR_RETURN(kernels, kernel_options(context_, library, model_, options, options.group_size));
  arithmetic_ = kernels.arithmetic;
  const std::vector<gl::Define>& defines = kernels.defines;
  const Binding constants = {BINDING_SIMULATION, &simulation_, gl::BufferKind::uniform};
  const Binding control = {BINDING_CONTROL, &control_};
  if (path_ == ForcePath::per_spring) {
    ASPIC_ASSIGN_OR_RETURN(force_program_,
                           context_.programs().compute(library, "compute/spring_forces.comp", defines));
    passes_.emplace_back(
        *force_program_,
        std::vector<Binding>{
            constants, control, {BINDING_SPRINGS, &springs_->springs}, {BINDING_SPRING_FORCES, &forces_}},
        Reader::compute_pass);
  }
  const char* kernel = path_ == ForcePath::gather ? "compute/gather.comp" : "compute/sum_springs.comp";
  ASPIC_ASSIGN_OR_RETURN(particle_program_, context_.programs().compute(library, kernel, defines));
  std::vector<Binding> bindings = {constants,
                                   control,
                                   pull_.binding(),
                                   poses_.binding(),
                                   {BINDING_STAGE_SUMS, &sums_},
                                   {BINDING_INCIDENT_START, &springs_->incident_start},
                                   {BINDING_INCIDENT, &springs_->incident}};
  if (path_ == ForcePath::per_spring) bindings.push_back({BINDING_SPRING_FORCES, &forces_});
  passes_.emplace_back(*particle_program_, std::move(bindings), Reader::compute_pass);
  return balls_.build(context_, model_, library, kernels, {&simulation_, &control_, false, poses_.binding()},
                      options.ball_search);
}

Status ComputeSolver::take(const State& state) {
  std::vector<layout::Particle> particles;
  ASPIC_ASSIGN_OR_RETURN(particles, to_device(state, model_));
  current_ = 0;
  states_[0].upload_items(std::span<const layout::Particle>(particles));
  balls_.load(state);
  ball_parity_ = 0;
  reset_control();
  poses_.set_base_step(state.step);
  base_step_ = state.step;
  steps_since_ = 0;
  divergence_.reset();
  return {};
}

void ComputeSolver::queue_step(std::uint32_t step_index, bool last_of_queue) {
  poses_.cover(step_index, 1);
  const std::size_t end = (current_ + 1) % 3, between = (current_ + 2) % 3;
  if (path_ == ForcePath::per_spring) force_program_->set(LOCATION_STEP, step_index);
  particle_program_->set(LOCATION_STEP, step_index);
  std::size_t stage_state = current_;
  for (std::uint32_t s = 0; s < stages_; ++s) {
    // Stages alternate between the two free buffers so that the last one lands in `end`.
    const std::size_t out = (stages_ - 1 - s) % 2 == 0 ? end : between;
    particle_program_->set(LOCATION_STAGE, s);
    const std::array<Binding, 3> states = {{{BINDING_STAGE_STATE, &states_[stage_state]},
                                            {BINDING_START_STATE, &states_[current_]},
                                            {BINDING_OUT_STATE, &states_[out]}}};
    if (path_ == ForcePath::per_spring) {
      passes_.front().dispatch_for(static_cast<std::uint32_t>(model_.springs.size()),
                                   std::span(states).first(1));
      mark(springs_kind);
    }
    const bool leaves = last_of_queue && s + 1 == stages_ && !balls_.any();
    passes_.back().dispatch_for(model_.particle_count(), states, leaves ? anyone : Reader::compute_pass);
    mark(particles_kind);
    stage_state = out;
  }
  balls_.queue(states_[current_], states_[end], step_index, ball_parity_,
               last_of_queue ? anyone : Reader::compute_pass);
  ball_parity_ = 1 - ball_parity_;
  current_ = end;
}

Result<std::optional<Divergence>> ComputeSolver::advance(std::uint64_t steps) {
  while (steps > 0 && !divergence_) {
    if (steps_since_ >
        0x7fffffffu) {  // the kernels count steps in 32 bits: begin anew, no step is under way here
      base_step_ += steps_since_;
      steps_since_ = 0;
      balls_.set_base_step(base_step_);
      poses_.set_base_step(base_step_);
    }
    const auto queue = static_cast<std::uint32_t>(std::min(steps, steps_per_look));
    const std::size_t first_state = current_;
    const std::uint32_t first_parity = ball_parity_;
    for (std::uint32_t n = 0; n < queue; ++n) {
      if (profiler_ && n == 0) profiler_->begin_step();
      queue_step(steps_since_ + n, n + 1 == queue);
      if (profiler_ && n == 0) profiler_->end_step();
    }
    const auto control = read_control();
    if (!control) return control.error();
    if (const Status ok = check_overrun(control->overrun); !ok) return ok.error();
    std::uint32_t good = queue;
    if (control->full_step != NO_STEP) {
      // Steps before it have passed; it is repeated from the state it began with, where nothing was written.
      good = control->full_step - steps_since_;
      if (const Status made = balls_.grow(); !made) return made.error();
      reset_control();
    } else if (control->bad_step != NO_STEP) {
      good = control->bad_step - steps_since_;
      divergence_ = divergence_from(control->bad_particle, base_step_ + control->bad_step + 1, model_);
    }
    current_ = (first_state + good) % 3;
    ball_parity_ = (first_parity + good) % 2;
    steps_since_ += good;
    steps -= good;
  }
  return divergence_;
}

void ComputeSolver::set_profiling(bool on) {
  if (on == (profiler_ != nullptr)) return;
  balls_.set_profiler(nullptr, 0);
  profiler_.reset();
  if (!on) return;
  const bool fused = path_ == ForcePath::gather;
  std::vector<std::string> names = {"spring forces",
                                    fused ? "springs, integration, contact" : "sums, integration, contact"};
  for (std::string& name : BallPasses::pass_names()) names.push_back(std::move(name));
  profiler_ = std::make_unique<gl::PassProfiler>(context_, std::move(names));
  balls_.set_profiler(profiler_.get(), ball_kinds);
}

void ComputeSolver::reset_control() {
  const layout::Control control = {NO_STEP, NO_STEP, NO_STEP, 0};
  control_.upload_items(std::span<const layout::Control>(&control, 1));
}

Result<layout::Control> ComputeSolver::read_control() {
  const layout::Control control = control_.download_items<layout::Control>(1).front();
  if (const Status ok = check_device(context_); !ok) return ok.error();
  return control;
}

Result<State> ComputeSolver::state() {
  const auto particles = states_[current_].download_items<layout::Particle>(model_.particle_count());
  State state = from_device(particles, base_step_ + steps_since_);
  balls_.read(state, ball_parity_);
  if (const Status ok = check_device(context_); !ok) return ok.error();
  return state;
}

}  // namespace

std::string_view name_of(ForcePath path) {
  switch (path) {
    case ForcePath::automatic:
      return "auto";
    case ForcePath::per_spring:
      return "per-spring";
    case ForcePath::gather:
      return "gather";
    case ForcePath::lattice:
      return "lattice";
  }
  return "";
}

Result<std::unique_ptr<GpuSolver>> make_gpu_solver(gl::Context& context, const Model& model,
                                                   const GpuOptions& options) {
  if (options.force_path == ForcePath::lattice) {
    return Error{ErrorCode::scene_rejected,
                 "the force path lattice is not built yet in this version: use gather or per-spring"};
  }
  if (context.lost()) return context.lost_error();
  // Without particles there is nothing to solve: balls fly by the formula.
  if (model.simulation.integrator == Integrator::implicit_euler && model.particle_count() > 0) {
    if (options.force_path == ForcePath::per_spring) {
      return Error{ErrorCode::scene_rejected,
                   "implicit-euler evaluates springs by gather alone: use the force path auto or gather"};
    }
    return make_implicit_solver(context, model, options);
  }
  const ForcePath path = options.force_path == ForcePath::automatic ? ForcePath::gather : options.force_path;
  auto solver = std::make_unique<ComputeSolver>(context, model, path);
  if (const Status built = solver->build(options); !built) return built.error();
  return std::unique_ptr<GpuSolver>(std::move(solver));
}

std::uint64_t gpu_bytes(const ModelCounts& counts, Integrator integrator, ForcePath path) {
  if (integrator == Integrator::implicit_euler && counts.particles > 0) {
    const std::uint64_t blocks = (counts.particles + REDUCTION_BLOCK - 1) / REDUCTION_BLOCK;
    return ball_bytes(counts) +
           counts.particles * (2 * sizeof(layout::Particle) + (2 + OWN_VECTORS) * sizeof(layout::vec4)) +
           sizeof(layout::Simulation) + sizeof(layout::Pull) + sizeof(layout::Solve) +
           blocks * sizeof(layout::vec4) + 4 * (counts.particles + 1) + 8 * counts.springs();
  }
  const std::uint64_t states = keeps_sums(*method_of(integrator)) ? 4 : 3;
  std::uint64_t bytes = ball_bytes(counts) + states * counts.particles * sizeof(layout::Particle) +
                        sizeof(layout::Simulation) + sizeof(layout::Pull) + sizeof(layout::Control) +
                        4 * (counts.particles + 1) + 8 * counts.springs();
  if (path == ForcePath::per_spring)
    bytes += counts.springs() * (sizeof(layout::uvec2) + sizeof(layout::vec4));
  return bytes;
}

}  // namespace aspic
