#include <algorithm>
#include <array>
#include <chrono>
#include <utility>

#include "gpu_solver/device_solver.h"
#include "gpu_solver/queue_depth.h"

namespace aspic {
namespace {

using gl::Binding;
using gl::Buffer;
using gl::ReadBy;

using Clock = std::chrono::steady_clock;

/// Steps queued between two looks at the Solve block, at most.
constexpr std::uint32_t most_steps = 16;
/// Rounds queued for the first step, before there is one to learn from, and at least where a step needed more
/// than was queued.
constexpr std::uint32_t first_rounds = 8, more_rounds = 16;
/// Rounds queued for one step without a look, at most.
constexpr std::uint32_t most_queued_rounds = 4096;

enum Kernel : std::size_t { begin, evaluate, apply, update, direction, finish, kernel_count };
constexpr std::array<KernelRow, kernel_count> kernel_rows = {
    {{"compute/implicit_begin.comp", "start of the step"},
     {"compute/implicit_evaluate.comp", "residual"},
     {"compute/implicit_apply.comp", "Jacobian times direction"},
     {"compute/implicit_update.comp", "solution update"},
     {"compute/implicit_direction.comp", "search direction"},
     {"compute/implicit_finish.comp", "end of the step, contact"}}};

std::uint64_t solve_bytes(std::uint64_t particles) {
  const std::uint64_t blocks = (particles + REDUCTION_BLOCK - 1) / REDUCTION_BLOCK;
  return sizeof(layout::Solve) + blocks * sizeof(layout::vec4);
}

class ImplicitSolver final : public DeviceSolver {
 public:
  ImplicitSolver(gl::Context& context, const Model& model, const ForcePathRow& path)
      : DeviceSolver(context, model, path, 2, titles_of(kernel_rows)) {}

  Result<std::optional<Divergence>> advance(std::uint64_t steps) override;
  std::optional<SolveStatistics> solve_statistics() override { return statistics_; }

 private:
  std::uint32_t group_size(const GpuOptions&) const override { return REDUCTION_BLOCK; }
  Status build_passes(const KernelOptions& kernels, const GpuOptions& options) override;
  void restart() override;
  void dispatch(Kernel kernel, ReadBy readers = ReadBy::compute_pass) const {
    passes_[kernel].dispatch_for(model_.particle_count(), {}, readers);
    mark(kernel);
  }
  void queue_rounds(std::uint32_t rounds) const;
  /// More than a step can take.
  std::uint64_t most_rounds() const;
  std::uint32_t rounds_wanted() const;
  Status solve_queue();
  void write_solve();
  Status read_solve();
  void take_statistics(const layout::Solve& before);

  Buffer trial_, search_, own_, solve_buffer_;
  std::vector<gl::Pass> passes_;  // by Kernel
  layout::Solve solve_{};         // as last read or written
  SolveStatistics statistics_;
  QueueDepth depth_{most_steps}, round_depth_{most_queued_rounds, first_rounds};
};

Status ImplicitSolver::build_passes(const KernelOptions& kernels, const GpuOptions& options) {
  const std::uint64_t particles = model_.particle_count(), vectors = particles * sizeof(layout::vec4);
  ASPIC_TRY(trial_, Buffer::create(context_, "trial velocities", vectors));
  ASPIC_TRY(search_, Buffer::create(context_, "search direction", vectors));
  ASPIC_TRY(own_, Buffer::create(context_, "solver vectors", OWN_VECTORS * vectors));
  ASPIC_TRY(solve_buffer_, Buffer::create(context_, "solve control", solve_bytes(particles)));
  const std::vector<Binding> bindings = {constants(),
                                         pull_.binding(),
                                         poses_.binding(),
                                         {BINDING_STATE_A, &states_[0]},
                                         {BINDING_STATE_B, &states_[1]},
                                         {BINDING_TRIAL, &trial_},
                                         {BINDING_SEARCH, &search_},
                                         {BINDING_INCIDENT_START, &springs_->incident_start},
                                         {BINDING_INCIDENT, &springs_->incident},
                                         lattices(),
                                         {BINDING_SOLVE, &solve_buffer_},
                                         {BINDING_OWN, &own_}};
  for (const KernelRow& row : kernel_rows) {
    ASPIC_TRY(auto made, pass(kernels, row.path, bindings));
    passes_.push_back(std::move(made));
  }
  return balls_.build(context_, model_, kernels,
                      {&simulation_, &solve_buffer_, true, poses_.binding(), pull_.binding()},
                      options.ball_search);
}

void ImplicitSolver::restart() {
  solve_ = {};
  solve_.bad_particle = NO_STEP;
  write_solve();
  statistics_ = {};
}

std::uint64_t ImplicitSolver::most_rounds() const {
  const ImplicitSettings& implicit = model_.simulation.implicit;
  const auto iterations = static_cast<std::uint64_t>(implicit.newton_iterations),
             rounds = static_cast<std::uint64_t>(implicit.cg_iterations) + max_halvings + 3;
  return (iterations + 1) * rounds;
}

void ImplicitSolver::write_solve() {
  solve_buffer_.upload_items(std::span(&solve_, 1));
}

Status ImplicitSolver::read_solve() {
  // A lost device answers with anything, also with a parity that names no state.
  const layout::Solve read = solve_buffer_.download_items<layout::Solve>(1).front();
  ASPIC_CHECK(context_.check());
  ASPIC_CHECK(check_overrun(read.overrun));
  const layout::Solve before = std::exchange(solve_, read);
  current_ = ball_slot_ = solve_.parity;
  steps_since_ = solve_.step;
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
  dispatch(finish, balls_.any() ? ReadBy::compute_pass : anyone);
  balls_.queue(states_[0], states_[1], 0, 0, anyone);
}

Result<std::optional<Divergence>> ImplicitSolver::advance(std::uint64_t steps) {
  // A step that is measured is queued alone: what is queued behind it may turn out to belong to it.
  bool measure = profiler_ != nullptr;
  while (steps > 0 && !divergence_) {
    keep_counting();
    solve_.step = steps_since_;
    const bool measured = std::exchange(measure, false) && profiler_->begin();
    const auto wanted =
        measured ? 1u : static_cast<std::uint32_t>(std::min<std::uint64_t>(steps, depth_.next()));
    const std::uint32_t queue = poses_.cover(solve_.step, wanted);
    const std::uint32_t first = solve_.step;
    const auto begun = Clock::now();
    solve_.target_step = first + queue;
    solve_.phase = PHASE_BEGIN;
    write_solve();
    ASPIC_CHECK(solve_queue());
    if (measured) profiler_->end();
    if (solve_.phase == PHASE_HALTED) {
      divergence_ = divergence_from(solve_.bad_particle, solve_.step);
    }
    const std::uint32_t done = solve_.step - first;
    depth_.took(done, std::chrono::duration<double>(Clock::now() - begun).count());
    steps -= done;
  }
  return divergence_;
}

/// As many as the last step took, or this one so far, and a quarter more.
std::uint32_t ImplicitSolver::rounds_wanted() const {
  if (solve_.ticks == 0) return first_rounds;
  const std::uint32_t learnt = solve_.ticks + solve_.ticks / 4 + 1;
  return solve_.phase == PHASE_BEGIN ? learnt : std::max(more_rounds, learnt);
}

/// Until the device has reached the target step or halted. No more rounds are queued for a step than take a
/// moment; what is missing is queued on, what is too much does nothing. Neither changes a bit.
Status ImplicitSolver::solve_queue() {
  std::uint32_t looked = solve_.step;
  std::uint64_t queued = 0;  // rounds of this step
  while (solve_.phase != PHASE_IDLE && solve_.phase != PHASE_HALTED) {
    if (solve_.step != looked) queued = 0;
    looked = solve_.step;
    if (queued > most_rounds()) return idle_device(context_, model_, queued * kernel_count);
    const std::uint32_t rounds = std::min(rounds_wanted(), round_depth_.next());
    queued += rounds;
    const auto begun = Clock::now();
    const layout::Solve before = solve_;
    std::uint32_t n = solve_.step;
    if (solve_.phase != PHASE_BEGIN) {
      queue_rounds(rounds);
      ++n;
    }
    for (; n < solve_.target_step; ++n) {
      dispatch(begin);
      queue_rounds(rounds);
    }
    ASPIC_CHECK(read_solve());
    const std::uint32_t ended = solve_.step - before.step, worked = ended > 0 ? ended * solve_.ticks
                                                                    : before.phase == PHASE_BEGIN
                                                                        ? solve_.ticks
                                                                        : solve_.ticks - before.ticks;
    round_depth_.took(std::max(worked, 1u), std::chrono::duration<double>(Clock::now() - begun).count());
    if (solve_.full != 0) {
      // The balls' part of the step is repeated, from the state it began with, where nothing was written.
      ASPIC_CHECK(balls_.grow());
      solve_.full = 0;
      queued = 0;
      write_solve();
    }
  }
  return {};
}

}  // namespace

Result<std::unique_ptr<GpuSolver>> make_implicit_solver(gl::Context& context, const Model& model,
                                                        const GpuOptions& options, const ForcePathRow& path) {
  auto solver = std::make_unique<ImplicitSolver>(context, model, path);
  ASPIC_CHECK(solver->build(options));
  return std::unique_ptr<GpuSolver>(std::move(solver));
}

std::uint64_t implicit_bytes(const ModelCounts& counts) {
  return counts.particles * (2 * sizeof(layout::Particle) + (2 + OWN_VECTORS) * sizeof(layout::vec4)) +
         solve_bytes(counts.particles);
}

}  // namespace aspic
