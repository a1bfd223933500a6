#include <algorithm>
#include <array>
#include <chrono>
#include <deque>
#include <utility>

#include "gpu/read_ring.h"
#include "gpu_solver/device_solver.h"
#include "gpu_solver/implicit_contact_passes.h"
#include "gpu_solver/implicit_kernels.h"
#include "gpu_solver/queue_depth.h"

namespace aspic {
namespace {

using namespace implicit;
using gl::Binding;
using gl::Buffer;
using gl::ReadBy;

using Clock = std::chrono::steady_clock;

/// Steps queued between two looks at the Solve block, at most.
constexpr std::uint32_t most_solves = 16;
/// Rounds queued for the first step, before there is one to learn from, and at least where a step needed more
/// than was queued.
constexpr std::uint32_t first_rounds = 8, more_rounds = 16;
/// Rounds queued for one step without a look, at most.
constexpr std::uint32_t most_queued_rounds = 4096;

class ImplicitSolver final : public DeviceSolver {
 public:
  ImplicitSolver(gl::Context& context, SharedModel model, const ForcePathRow& path)
      : DeviceSolver(context, std::move(model), path, 2, titles_of(implicit_kernels)) {}

  std::optional<SolveStatistics> solve_statistics() override { return statistics_; }
  void set_late(bool on) override { late_ = on; }

 private:
  std::uint32_t group_size(const GpuOptions&) const override { return REDUCTION_BLOCK; }
  Status build_passes(const KernelOptions& kernels, const GpuOptions& options) override;
  void restart() override;
  void dispatch(Kernel kernel, ReadBy readers = ReadBy::compute_pass) const {
    passes_[kernel].dispatch(buffers_, readers);
    mark(kernel);
  }
  // A step may end in a later queue than its own, and would meet the pulls of that one.
  bool repeats_steps() const override { return true; }
  Status take_steps(std::uint64_t steps) override;
  Status settle() override { return carry_out(0, true); }
  Status carry_out(std::uint64_t steps, bool wait);
  Result<std::uint32_t> work_on(std::uint64_t steps, bool must);
  bool is_behind() const { return solve_.step != target_; }
  void queue_rounds(std::uint32_t rounds) const;
  std::uint32_t queue_steps(std::uint32_t wanted);
  void queue_more();
  void submit(std::uint32_t rounds);
  Status take_look();
  Status repeat_balls();
  void wait_for_lists();
  Status make_lists();
  bool eases() const { return contact_.any() && time() < contact_.eased_until(); }
  /// Of the state last seen, since the initial state [s], as in src/collision/contact_search.cpp.
  double time() const { return static_cast<double>(base_step_ + solve_.step) * model_->simulation.timestep; }
  void begin_step() const;
  void forget_queues();
  void predict_state();
  /// More than a step can take.
  std::uint64_t most_rounds() const;
  std::uint32_t rounds_wanted() const;
  void write_solve();
  void take_statistics(const layout::Solve& before);

  ImplicitContactPasses contact_passes_{contact_};
  Buffer trial_, search_, own_, solve_buffer_;
  std::vector<ItemPass> passes_;          // by Kernel
  std::vector<Binding> buffers_;          // of every pass
  layout::Solve solve_{};                 // as last read or written
  std::uint32_t target_ = 0;              // the device's target_step after all queues
  std::uint64_t queued_rounds_ = 0;       // since a step was last seen to end
  std::deque<Clock::time_point> queues_;  // under way: when each began
  std::optional<gl::ReadRing> looks_;     // the Solve block after each queue
  Clock::time_point last_look_ = {};
  std::optional<Error> unusable_;  // the device dropped passes
  bool look_failed_ = false;       // a look failed: the device has got further than solve_ says
  bool late_ = false;
  SolveStatistics statistics_;
  QueueDepth depth_{most_solves}, round_depth_{most_queued_rounds, first_rounds};
};

Status ImplicitSolver::build_passes(const KernelOptions& kernels, const GpuOptions& options) {
  const std::uint64_t particles = model_->particle_count(), vectors = particles * sizeof(layout::vec4);
  ASPIC_TRY(trial_, Buffer::create(context_, "trial velocities", vectors));
  ASPIC_TRY(own_, Buffer::create(context_, "solver vectors", OWN_VECTORS * vectors));
  const std::uint64_t contact_vectors = contact_.any() ? CONTACT_VECTORS * vectors : 0;
  ASPIC_TRY(search_, Buffer::create(context_, "search direction", vectors + contact_vectors));
  ASPIC_TRY(solve_buffer_, Buffer::create(context_, "solve control", solve_bytes(particles)));
  looks_.emplace(context_, sizeof(layout::Solve));
  const std::vector<Binding> bindings = {constants(), pulls_.binding(), poses_.binding(),
                                         starts(),    lattices(),       {BINDING_SOLVE, &solve_buffer_}};
  buffers_ = {{BINDING_STATE_A, &states_[0]}, {BINDING_STATE_B, &states_[1]},
              {BINDING_TRIAL, &trial_},       {BINDING_SEARCH, &search_},
              {BINDING_OWN, &own_},           {BINDING_INCIDENT, &springs_->incident}};
  KernelOptions own_kernels = kernels;
  if (contact_.any()) own_kernels.defines.push_back({"ASPIC_BODY_CONTACT", "1"});
  if (lengths_.any()) own_kernels.defines.push_back({"ASPIC_ACTUATED", "1"});
  ASPIC_CHECK(contact_passes_.build(kernels, {constants(),
                                              {BINDING_SOLVE, &solve_buffer_},
                                              {BINDING_STATE_A, &states_[0]},
                                              {BINDING_STATE_B, &states_[1]},
                                              {BINDING_TRIAL, &trial_},
                                              {BINDING_SEARCH, &search_}}));
  for (const KernelRow& row : implicit_kernels) {
    ASPIC_TRY(auto made, item_pass(own_kernels, row.path, bindings, model_->particle_count()));
    passes_.push_back(std::move(made));
  }
  return balls_.build(context_, *model_, kernels,
                      {&simulation_, &solve_buffer_, true, poses_.binding(), pulls_.binding()},
                      options.ball_search);
}

void ImplicitSolver::restart() {
  solve_ = {};
  solve_.bad_particle = NO_STEP;
  target_ = 0;
  forget_queues();
  unusable_.reset();
  look_failed_ = false;
  write_solve();
  statistics_ = {};
}

void ImplicitSolver::forget_queues() {
  queues_.clear();
  looks_->forget();
  queued_rounds_ = 0;
}

std::uint64_t ImplicitSolver::most_rounds() const {
  const ImplicitSettings& implicit = model_->simulation.implicit;
  const auto iterations = static_cast<std::uint64_t>(implicit.newton_iterations),
             rounds = static_cast<std::uint64_t>(implicit.cg_iterations) + max_halvings + 3;
  const std::uint64_t solves = contact_.any() ? 2 : 1;
  return solves * (iterations + 1) * rounds;
}

void ImplicitSolver::write_solve() {
  solve_buffer_.upload_items(std::span(&solve_, 1));
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
    if (contact_.acts()) contact_passes_.queue_forces(static_cast<float>(time()));
    dispatch(evaluate);
    if (contact_.acts()) contact_passes_.queue_product();
    for (const Kernel kernel : {apply, update, direction}) dispatch(kernel);
  }
  dispatch(finish, balls_.any() ? ReadBy::compute_pass : anyone);
  balls_.queue(states_[0], states_[1], 0, 0, anyone);
}

Status ImplicitSolver::take_steps(std::uint64_t steps) {
  // A step that is measured is queued alone: rounds queued behind it may turn out to belong to it.
  if (profiler_ && steps > 0) {
    ASPIC_CHECK(settle());
    if (!divergence_ && profiler_->begin()) {
      ASPIC_CHECK(carry_out(1, true));
      profiler_->end();
      --steps;
    }
  }
  return carry_out(steps, !late_);
}

/// As many as the last step took, or this one so far, and a quarter more.
std::uint32_t ImplicitSolver::rounds_wanted() const {
  if (solve_.ticks == 0) return first_rounds;
  const std::uint32_t learnt = solve_.ticks + solve_.ticks / 4 + 1;
  const bool between = solve_.phase == PHASE_BEGIN || solve_.phase == PHASE_IDLE;
  return between ? learnt : std::max(more_rounds, learnt);
}

/// Queues steps, and polls those before. No more rounds are queued for a step than take a moment; missing
/// rounds are queued later, surplus ones do nothing. Neither changes a bit.
Status ImplicitSolver::carry_out(std::uint64_t steps, bool wait) {
  if (unusable_) return *unusable_;
  if (std::exchange(look_failed_, false)) submit(0);
  while (!divergence_) {
    const bool idle = queues_.empty() && !is_behind();
    const bool must = queues_.size() == most_queues || (steps == 0 ? wait : counts_far());
    if (steps == 0 && (idle || (!must && !queues_.empty() && !looks_->ready()))) break;
    const auto queued = work_on(steps, must);
    if (!queued) {
      forget_queues();
      look_failed_ = true;
      return queued.error();
    }
    steps -= *queued;
  }
  return {};
}

/// Polls the device, or queues missing rounds or new steps; returns how many new steps are queued.
Result<std::uint32_t> ImplicitSolver::work_on(std::uint64_t steps, bool must) {
  std::uint32_t queued = 0;
  // While bodies are eased apart, a step's passes are told its time.
  if (!queues_.empty() && (must || eases() || looks_->ready())) {
    ASPIC_CHECK(take_look());
  } else if (queues_.empty() && is_behind()) {
    if (queued_rounds_ > most_rounds()) {
      unusable_ = idle_device(context_, *model_, queued_rounds_ * kernel_count);
      return *unusable_;
    }
    ASPIC_CHECK(make_lists());
    queue_more();
  } else {
    ASPIC_CHECK(make_lists());
    std::uint64_t worth =
        contact_.any() ? std::min<std::uint64_t>(depth_.next(), contact_.patience()) : depth_.next();
    if (eases()) worth = 1;
    queued = queue_steps(static_cast<std::uint32_t>(std::min(steps, worth)));
    if (queued == 0) ASPIC_CHECK(take_look());  // the table of poses has no room
  }
  return queued;
}

/// Steps behind those that are queued; returns how many there was room for.
std::uint32_t ImplicitSolver::queue_steps(std::uint32_t wanted) {
  if (queues_.empty()) {
    keep_counting();
    solve_.step = target_ = steps_since_;
  }
  // Steps that are queued already may end behind this.
  const std::uint32_t before = target_ - solve_.step,
                      covered = lengths_.cover(solve_.step, poses_.cover(solve_.step, before + wanted)),
                      steps = covered - std::min(covered, before);
  if (steps == 0) return 0;
  target_ += steps;
  if (queues_.empty()) {
    solve_.target_step = target_;
    solve_.phase = PHASE_BEGIN;
    write_solve();
  } else {
    solve_buffer_.upload_items(std::span(&target_, 1),
                               offsetof(layout::Solve, target_step) / sizeof(target_));
  }
  const std::uint32_t rounds = std::min(rounds_wanted(), round_depth_.next());
  for (std::uint32_t n = 0; n < steps; ++n) {
    begin_step();
    queue_rounds(rounds);
  }
  submit(rounds);
  return steps;
}

void ImplicitSolver::begin_step() const {
  if (contact_.any()) contact_passes_.queue_start();
  if (contact_.any()) passes_[begin].program().set(LOCATION_CONTACT_COUNT, contact_.group_count());
  dispatch(begin);
}

/// Steps wait for lists of what is near that hold; nothing is queued.
void ImplicitSolver::wait_for_lists() {
  forget_queues();
  contact_.forget();
  solve_.stale = 0;
  solve_.phase = PHASE_BEGIN;
}

/// What is near bodies in the state last seen. Nothing may be queued if the lists do not hold.
Status ImplicitSolver::make_lists() {
  if (contact_.fresh()) return {};
  ASPIC_CHECK(contact_.refresh(states_[solve_.parity]));
  search_.clear();  // only listed particles write there
  solve_.target_step = target_;
  write_solve();
  return {};
}

/// Queues the rounds that steps of earlier queues still need.
void ImplicitSolver::queue_more() {
  const std::uint32_t rounds = std::min(rounds_wanted(), round_depth_.next());
  std::uint32_t n = solve_.step;
  if (solve_.phase != PHASE_BEGIN) {
    queue_rounds(rounds);
    ++n;
  }
  for (; n != target_; ++n) {
    begin_step();
    queue_rounds(rounds);
  }
  submit(rounds);
}

void ImplicitSolver::submit(std::uint32_t rounds) {
  queued_rounds_ += rounds;
  queues_.push_back(Clock::now());
  looks_->submit(solve_buffer_, 0, sizeof(layout::Solve));
  predict_state();
}

/// Where the state will be once all queues have ended.
void ImplicitSolver::predict_state() {
  steps_since_ = target_;
  current_ = ball_slot_ = (solve_.parity + (target_ - solve_.step)) % 2;
}

/// Waits for the oldest queue and reads its outcome.
Status ImplicitSolver::take_look() {
  layout::Solve read;
  looks_->take(std::as_writable_bytes(std::span(&read, 1)));
  // A lost device answers with anything, also with a parity that names no state.
  ASPIC_CHECK(context_.check());
  if (read.overrun == ITEMS_MISSING) {
    unusable_ = idle_device(context_, *model_, queued_rounds_);
    return *unusable_;
  }
  ASPIC_CHECK(check_overrun(read.overrun));
  const layout::Solve before = std::exchange(solve_, read);
  take_statistics(before);
  const auto now = Clock::now();
  const double seconds = std::chrono::duration<double>(now - std::max(queues_.front(), last_look_)).count();
  queues_.pop_front();
  last_look_ = now;
  const bool restarted = before.phase == PHASE_BEGIN || before.phase == PHASE_IDLE;
  const std::uint32_t ended = solve_.step - before.step,
                      worked =
                          ended > 0 ? ended * solve_.ticks : solve_.ticks - (restarted ? 0 : before.ticks);
  depth_.took(ended, seconds);
  round_depth_.took(std::max(worked, 1u), seconds);
  if (ended > 0) queued_rounds_ = 0;
  if (contact_.any()) contact_.held(ended);
  if (solve_.full != 0) return repeat_balls();
  if (solve_.stale != 0) wait_for_lists();
  if (solve_.phase == PHASE_HALTED) {
    forget_queues();
    target_ = solve_.step;
    divergence_ = divergence_from(solve_.bad_particle, solve_.step);
  }
  predict_state();
  return {};
}

/// The balls' part of a step is repeated, from the state it began with, where nothing was written. Steps
/// queued behind it have done nothing.
Status ImplicitSolver::repeat_balls() {
  forget_queues();
  ASPIC_CHECK(balls_.grow());
  solve_.full = 0;
  solve_.target_step = target_;
  write_solve();
  return {};
}

Result<std::unique_ptr<GpuSolver>> make_implicit_solver(gl::Context& context, SharedModel model,
                                                        const GpuOptions& options, const ForcePathRow& path) {
  auto solver = std::make_unique<ImplicitSolver>(context, std::move(model), path);
  ASPIC_CHECK(solver->build(options));
  return std::unique_ptr<GpuSolver>(std::move(solver));
}

std::uint64_t implicit_bytes(const ModelCounts& counts, Integrator) {
  constexpr std::uint64_t vectors = 2 + OWN_VECTORS;  // with trial velocities and search directions
  return counts.particles * (2 * sizeof(layout::Particle) + vectors * sizeof(layout::vec4)) +
         solve_bytes(counts.particles);
}

}  // namespace

const DeviceMethod newton_method = {make_implicit_solver,
                                    [](const ForcePathRow& path) { return path.implicit; }, implicit_bytes,
                                    OWN_VECTORS * sizeof(layout::vec4), false};

}  // namespace aspic
