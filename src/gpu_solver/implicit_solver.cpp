#include "gpu_solver/implicit_solver.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "gpu/pass.h"
#include "gpu/program_cache.h"
#include "gpu_solver/ball_passes.h"
#include "gpu_solver/pose_buffer.h"
#include "gpu_solver/pull_buffer.h"
#include "gpu_solver/simulation_block.h"
#include "gpu_solver/spring_buffers.h"
#include "gpu_solver/support.h"

namespace aspic {
namespace {

using gl::Binding;
using gl::Buffer;
using gl::Reader;

/// Steps queued between two looks at the Solve block.
constexpr std::uint64_t steps_per_look = 16;
/// Rounds queued for the first step, before there is one to learn from, and whenever a step needed more than
/// was queued.
constexpr std::uint32_t first_rounds = 32, more_rounds = 16;
/// Readers of a state and a Solve block that are about to leave the solver.
constexpr Reader anyone = Reader::compute_pass | Reader::vertex_draw | Reader::read_back | Reader::copy;

enum Kernel : std::size_t { begin, evaluate, apply, update, direction, finish, kernel_count };
constexpr std::array<const char*, kernel_count> kernel_paths = {
    "compute/implicit_begin.comp",  "compute/implicit_evaluate.comp",  "compute/implicit_apply.comp",
    "compute/implicit_update.comp", "compute/implicit_direction.comp", "compute/implicit_finish.comp"};

class ImplicitSolver final : public GpuSolver {
 public:
  ImplicitSolver(gl::Context& context, const Model& model) : context_(context), model_(model) {}

  Status build(const GpuOptions& options);

  std::string_view backend() const override { return "gpu"; }
  std::string description() const override {
    return fmt::format("gpu, {}, force path gather, single precision", context_.info().renderer);
  }
  Precision precision() const override { return Precision::single; }
  const Model& model() const override { return model_; }
  std::uint64_t bytes() const override { return bytes_ + balls_.grown_bytes(); }
  const Buffer& particles() const override { return states_[solve_.parity]; }
  const Buffer& balls() const override { return balls_.buffer(); }
  std::uint32_t first_ball() const override { return solve_.parity * model_.ball_count(); }
  ForcePath force_path() const override { return ForcePath::gather; }
  const gl::Arithmetic& arithmetic() const override { return arithmetic_; }
  const std::shared_ptr<const SpringBuffers>& spring_buffers() const override { return springs_; }

  Status load(const State& state) override {
    const Status taken = take(state);
    return taken ? check_device(context_) : taken;
  }
  Status set_pull(const std::optional<Pull>& pull) override { return pull_.set(model_, pull); }
  Result<std::optional<Divergence>> advance(std::uint64_t steps) override;
  std::optional<SolveStatistics> solve_statistics() override { return statistics_; }
  Result<State> state() override;
  void set_profiling(bool on) override;
  std::vector<gl::PassTime> pass_times() override {
    return profiler_ ? profiler_->times() : std::vector<gl::PassTime>();
  }

 private:
  Status take(const State& state);
  Status build_buffers(const GpuOptions& options);
  void dispatch(Kernel kernel, Reader readers = Reader::compute_pass) const {
    passes_[kernel].dispatch_for(model_.particle_count(), {}, readers);
    if (profiler_) profiler_->mark(kernel);
  }
  void queue_rounds(std::uint32_t rounds) const;
  void write_solve();
  Status read_solve();
  void take_statistics(const layout::Solve& before);

  gl::Context& context_;
  const Model& model_;
  std::uint64_t bytes_ = 0;
  std::array<Buffer, 2> states_;
  Buffer trial_, search_, own_, simulation_, solve_buffer_;
  std::shared_ptr<const SpringBuffers> springs_;
  PullBuffer pull_;
  PoseBuffer poses_;
  gl::Arithmetic arithmetic_;
  std::array<std::shared_ptr<const gl::Program>, kernel_count> programs_;
  std::vector<gl::Pass> passes_;  // by Kernel
  BallPasses balls_;

  layout::Solve solve_{};  // as last read or written
  std::uint64_t base_step_ = 0;
  SolveStatistics statistics_;
  std::optional<Divergence> divergence_;
  std::unique_ptr<gl::PassProfiler> profiler_;
};

Status ImplicitSolver::build_buffers(const GpuOptions& options) {
  std::vector<layout::Simulation> block(1);
  ASPIC_ASSIGN_OR_RETURN(block[0], simulation_block(model_));
  const std::uint64_t particles = model_.particle_count(), vectors = particles * sizeof(layout::vec4);
  const std::uint64_t blocks = (particles + REDUCTION_BLOCK - 1) / REDUCTION_BLOCK;
  for (Buffer& state : states_) {
    ASPIC_ASSIGN_OR_RETURN(state,
                           Buffer::create(context_, "particle state", particles * sizeof(layout::Particle)));
  }
  ASPIC_ASSIGN_OR_RETURN(trial_, Buffer::create(context_, "trial velocities", vectors));
  ASPIC_ASSIGN_OR_RETURN(search_, Buffer::create(context_, "search direction", vectors));
  ASPIC_ASSIGN_OR_RETURN(own_, Buffer::create(context_, "solver vectors", OWN_VECTORS * vectors));
  ASPIC_ASSIGN_OR_RETURN(
      solve_buffer_,
      Buffer::create(context_, "solve control", sizeof(layout::Solve) + blocks * sizeof(layout::vec4)));
  ASPIC_ASSIGN_OR_RETURN(
      simulation_, Buffer::of(context_, "simulation constants", std::span<const layout::Simulation>(block),
                              gl::BufferKind::uniform));
  if (const Status made = pull_.build(context_); !made) return made;
  if (const Status made = poses_.build(context_, model_); !made) return made;
  ASPIC_ASSIGN_OR_RETURN(springs_, aspic::spring_buffers(context_, model_, ForcePath::gather, options.like));
  return {};
}

Status ImplicitSolver::build(const GpuOptions& options) {
  const std::uint64_t held_before = context_.bytes_held();
  if (const Status made = build_buffers(options); !made) return made;

  const gl::ShaderLibrary library(options.shader_directory);
  KernelOptions kernels;
  ASPIC_ASSIGN_OR_RETURN(kernels, kernel_options(context_, library, model_, options, REDUCTION_BLOCK));
  arithmetic_ = kernels.arithmetic;
  const std::vector<Binding> bindings = {{BINDING_SIMULATION, &simulation_, gl::BufferKind::uniform},
                                         pull_.binding(),
                                         poses_.binding(),
                                         {BINDING_STATE_A, &states_[0]},
                                         {BINDING_STATE_B, &states_[1]},
                                         {BINDING_TRIAL, &trial_},
                                         {BINDING_SEARCH, &search_},
                                         {BINDING_INCIDENT_START, &springs_->incident_start},
                                         {BINDING_INCIDENT, &springs_->incident},
                                         {BINDING_SOLVE, &solve_buffer_},
                                         {BINDING_OWN, &own_}};
  for (std::size_t k = 0; k < kernel_count; ++k) {
    ASPIC_ASSIGN_OR_RETURN(programs_[k],
                           context_.programs().compute(library, kernel_paths[k], kernels.defines));
    passes_.emplace_back(*programs_[k], bindings, Reader::compute_pass);
  }
  if (const Status made =
          balls_.build(context_, model_, library, kernels,
                       {&simulation_, &solve_buffer_, true, poses_.binding()}, options.ball_search);
      !made) {
    return made;
  }
  bytes_ = context_.bytes_held() - held_before;
  if (springs_.use_count() > 1) bytes_ += springs_->bytes();  // held before, by the solver it shares with
  if (const Status loaded = take(initial_state(model_, Precision::single)); !loaded) return loaded;
  return check_device(context_, ErrorCode::scene_rejected);
}

Status ImplicitSolver::take(const State& state) {
  std::vector<layout::Particle> particles;
  ASPIC_ASSIGN_OR_RETURN(particles, to_device(state, model_));
  states_[0].upload_items(std::span<const layout::Particle>(particles));
  balls_.load(state);
  solve_ = {};
  solve_.bad_particle = NO_STEP;
  write_solve();
  base_step_ = state.step;
  poses_.set_base_step(base_step_);
  statistics_ = {};
  divergence_.reset();
  return {};
}

void ImplicitSolver::write_solve() {
  solve_buffer_.upload_items(std::span<const layout::Solve>(&solve_, 1));
}

Status ImplicitSolver::read_solve() {
  // A lost device answers with anything, also with a parity that names no state.
  const layout::Solve read = solve_buffer_.download_items<layout::Solve>(1).front();
  if (const Status ok = check_device(context_); !ok) return ok;
  if (const Status ok = check_overrun(read.overrun); !ok) return ok;
  const layout::Solve before = std::exchange(solve_, read);
  take_statistics(before);
  return {};
}

/// The device's counters are 32-bit and wrap; their differences between two looks are right all the same.
void ImplicitSolver::take_statistics(const layout::Solve& before) {
  statistics_.steps += solve_.step - before.step;
  statistics_.converged += solve_.converged - before.converged;
  statistics_.stagnated += solve_.stagnated - before.stagnated;
  statistics_.not_converged += solve_.not_converged - before.not_converged;
  statistics_.newton_iterations += solve_.newton_sum - before.newton_sum;
  statistics_.cg_iterations += solve_.cg_sum - before.cg_sum;
  statistics_.worst_residual = static_cast<double>(solve_.worst_residual);
  statistics_.last = {solve_.last_newton, solve_.last_cg, static_cast<double>(solve_.last_residual),
                      static_cast<SolveEnd>(solve_.last_end)};
}

void ImplicitSolver::queue_rounds(std::uint32_t rounds) const {
  for (std::uint32_t r = 0; r < rounds; ++r) {
    for (const Kernel kernel : {evaluate, apply, update, direction}) dispatch(kernel);
  }
  dispatch(finish, balls_.any() ? Reader::compute_pass : anyone);
  balls_.queue(states_[0], states_[1], 0, 0, anyone);
}

void ImplicitSolver::set_profiling(bool on) {
  if (on == (profiler_ != nullptr)) return;
  balls_.set_profiler(nullptr, 0);
  profiler_.reset();
  if (!on) return;
  std::vector<std::string> names = {"start of the step", "residual",         "Jacobian times direction",
                                    "solution update",   "search direction", "end of the step, contact"};
  for (std::string& name : BallPasses::pass_names()) names.push_back(std::move(name));
  profiler_ = std::make_unique<gl::PassProfiler>(context_, std::move(names));
  balls_.set_profiler(profiler_.get(), kernel_count);
}

Result<std::optional<Divergence>> ImplicitSolver::advance(std::uint64_t steps) {
  // A step that is measured is queued alone: what is queued behind it may turn out to belong to it.
  bool measure = profiler_ != nullptr;
  while (steps > 0 && !divergence_) {
    if (solve_.step >
        0x7fffffffu) {  // the device counts steps in 32 bits: begin anew, no step is under way here
      base_step_ += solve_.step;
      solve_.step = 0;
      balls_.set_base_step(base_step_);
      poses_.set_base_step(base_step_);
    }
    const bool measured = std::exchange(measure, false) && profiler_->begin_step();
    const auto wanted = measured ? 1u : static_cast<std::uint32_t>(std::min(steps, steps_per_look));
    const std::uint32_t queue = poses_.cover(solve_.step, wanted);
    const std::uint32_t first = solve_.step;
    solve_.target_step = first + queue;
    solve_.phase = PHASE_BEGIN;
    write_solve();
    // As many rounds as the last step took and a quarter more; what is missing is queued on, what is too much
    // does nothing. Neither changes a bit.
    std::uint32_t rounds =
        solve_.last_ticks == 0 ? first_rounds : solve_.last_ticks + solve_.last_ticks / 4 + 1;
    while (solve_.phase != PHASE_IDLE && solve_.phase != PHASE_HALTED) {
      if (solve_.phase != PHASE_BEGIN) queue_rounds(more_rounds);
      for (std::uint32_t n = solve_.step; n < solve_.target_step; ++n) {
        dispatch(begin);
        queue_rounds(rounds);
      }
      if (const Status ok = read_solve(); !ok) return ok.error();
      if (solve_.full != 0) {
        // The balls' part of the step is repeated, from the state it began with, where nothing was written.
        if (const Status made = balls_.grow(); !made) return made.error();
        solve_.full = 0;
        write_solve();
      }
      rounds = std::max(more_rounds, solve_.last_ticks + solve_.last_ticks / 4 + 1);
    }
    if (measured) profiler_->end_step();
    if (solve_.phase == PHASE_HALTED) {
      divergence_ = divergence_from(solve_.bad_particle, base_step_ + solve_.step + 1, model_);
    }
    steps -= solve_.step - first;
  }
  return divergence_;
}

Result<State> ImplicitSolver::state() {
  const auto particles = states_[solve_.parity].download_items<layout::Particle>(model_.particle_count());
  State state = from_device(particles, base_step_ + solve_.step);
  balls_.read(state, solve_.parity);
  if (const Status ok = check_device(context_); !ok) return ok.error();
  return state;
}

}  // namespace

Result<std::unique_ptr<GpuSolver>> make_implicit_solver(gl::Context& context, const Model& model,
                                                        const GpuOptions& options) {
  auto solver = std::make_unique<ImplicitSolver>(context, model);
  if (const Status built = solver->build(options); !built) return built.error();
  return std::unique_ptr<GpuSolver>(std::move(solver));
}

}  // namespace aspic
