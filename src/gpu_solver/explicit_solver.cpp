#include <algorithm>
#include <array>
#include <chrono>
#include <deque>

#include "gpu/read_ring.h"
#include "gpu_solver/contact_passes.h"
#include "gpu_solver/device_solver.h"
#include "gpu_solver/group_size.h"
#include "gpu_solver/queue_depth.h"
#include "model/integrator.h"
#include "model/springs.h"

namespace aspic {
namespace {

using gl::Binding;
using gl::Buffer;
using gl::ReadBy;

using Clock = std::chrono::steady_clock;

/// Steps queued between two looks at the control words, at most.
constexpr std::uint32_t most_steps = 1024;

/// See GpuOptions::lattice_run.
constexpr std::uint32_t software_run = 4;

/// Whether the method's sums outlive a stage, so that memory must hold them.
bool keeps_sums(const Staged& method) {
  return std::any_of(method.stages.begin(), method.stages.end() - 1,
                     [](const Stage& s) { return s.weight != 0.0; });
}

class ExplicitSolver final : public DeviceSolver {
 public:
  // The step's start, its end, and a place for stages in between; the roles rotate with every step.
  ExplicitSolver(gl::Context& context, SharedModel model, const ForcePathRow& path)
      : DeviceSolver(context, std::move(model), path, 3,
                     {std::string(path.spring_title), std::string(path.lattice_title),
                      std::string(path.cell_title), std::string(path.particle_title)}),
        method_(*free_flight_row(model_->simulation.integrator).staged()) {}

  void set_late(bool on) override { late_ = on; }

 private:
  /// Steps that are queued, and not looked at yet.
  struct Queue {
    std::uint32_t count;
    std::size_t first_state;   // where they begin
    std::uint32_t first_slot;  // of the balls, likewise
    std::uint32_t first_step;
    Clock::time_point begun;
  };
  /// Kinds of passes, for the profiler.
  enum Kind : std::size_t { springs_kind, lattices_kind, cells_kind, particles_kind };
  std::uint32_t group_size(const GpuOptions& options) const override {
    return options.group_size > 0 ? options.group_size : group_size_on(context_.info());
  }
  Status build_passes(const KernelOptions& kernels, const GpuOptions& options) override;
  void restart() override;
  Status take_steps(std::uint64_t steps) override { return carry_out(steps, !late_); }
  Status settle() override { return carry_out(0, true); }
  Status carry_out(std::uint64_t steps, bool wait);
  std::uint32_t queue_steps(std::uint32_t count);
  Status build_lattice_pass(KernelOptions kernels, std::uint32_t run, const std::vector<Binding>& bindings);
  Status build_cell_passes(const KernelOptions& kernels, std::uint32_t run, std::vector<Binding> bindings);
  void dispatch(const std::optional<ItemPass>& pass, Kind kind, std::span<const Binding> buffers,
                ReadBy readers) const;
  Status build_rest(const KernelOptions& kernels, std::vector<Binding> bindings);
  void queue_rest(const ContactPasses::States& states, std::uint32_t step_index, std::uint32_t stage,
                  ReadBy readers) const;
  void queue_step(std::uint32_t step_index, bool last_of_queue);
  Result<std::uint64_t> take_look();
  void forget_queues();
  std::uint32_t passes_per_step() const;
  static std::uint32_t counted(std::uint32_t items) { return items > 0 ? COUNTED_OF(items) : 0u; }
  std::uint32_t counted_balls() const { return counted(model_->ball_count()); }
  /// Since the initial state [s], as in src/collision/contact_search.cpp.
  float time_of(std::uint32_t step_index) const {
    return static_cast<float>(static_cast<double>(base_step_ + step_index) * model_->simulation.timestep);
  }

  const Staged& method_;
  ContactPasses contact_passes_{contact_};
  std::shared_ptr<const gl::Program> rest_program_;  // where stages are two passes
  std::optional<gl::Pass> rest_pass_;
  Buffer sums_, control_, forces_;
  std::deque<Queue> queues_;
  std::optional<gl::ReadRing> looks_;  // the control words after each queue
  QueueDepth depth_{most_steps};
  Clock::time_point last_look_ = {};
  std::uint32_t passes_before_ = 0;  // counts that must have been made before the oldest queue
  std::optional<Error> unusable_;    // the device dropped passes
  bool late_ = false;
  // Of each stage.
  std::optional<ItemPass> spring_pass_, lattice_pass_, plain_pass_, mixed_pass_, particle_pass_;
};

Status ExplicitSolver::build_lattice_pass(KernelOptions kernels, std::uint32_t run,
                                          const std::vector<Binding>& bindings) {
  std::uint32_t items = 0;
  for (const Body& body : model_->bodies)
    if (body.box()) items += (body.particle_count - 1) / run + 1;
  kernels.defines.push_back({"ASPIC_LATTICE_RUN", std::to_string(run)});
  ASPIC_TRY(lattice_pass_, item_pass(kernels, path_.lattice_kernel, bindings, items));
  return {};
}

/// Of plain blocks and of mixed ones, as far as there are any.
Status ExplicitSolver::build_cell_passes(const KernelOptions& kernels, std::uint32_t run,
                                         std::vector<Binding> bindings) {
  bindings.push_back({BINDING_CELLS, &springs_->cells});
  bindings.push_back({BINDING_CELL_BODIES, &springs_->cell_bodies, gl::BufferKind::uniform});
  std::size_t kind = 0;
  for (auto* const pass : {&plain_pass_, &mixed_pass_}) {
    KernelOptions own = kernels;
    own.defines.push_back({"ASPIC_LATTICE_RUN", std::to_string(run)});
    if (kind == 1) own.defines.push_back({"ASPIC_MIXED", std::to_string(springs_->class_width)});
    const std::uint32_t items = springs_->blocks[kind] * (block_places / run);
    if (items > 0) {
      ASPIC_TRY(*pass, item_pass(own, path_.cell_kernel, bindings, items));
    }
    ++kind;
  }
  return {};
}

Status ExplicitSolver::build_passes(const KernelOptions& kernels, const GpuOptions& options) {
  const std::uint64_t state_bytes = states_[0].bytes();
  ASPIC_TRY(sums_, Buffer::create(context_, "stage sums", keeps_sums(method_) ? state_bytes : 0));
  ASPIC_TRY(control_, Buffer::create(context_, "control words", sizeof(layout::Control)));
  looks_.emplace(context_, sizeof(layout::Control));
  fast_ = options.spring_arithmetic == Arithmetic::fast;
  KernelOptions stage_kernels = kernels;
  if (fast_) stage_kernels.defines.push_back({"ASPIC_FAST", "1"});
  if (lengths_.any()) stage_kernels.defines.push_back({"ASPIC_ACTUATED", "1"});
  const Binding control = {BINDING_CONTROL, &control_};
  std::vector<Binding> bindings = {constants(),      control,  pulls_.binding(),
                                   poses_.binding(), starts(), lattices()};
  if (!path_.spring_kernel.empty()) {
    ASPIC_TRY(forces_,
              Buffer::create(context_, "spring forces", spring_count(*model_) * sizeof(layout::vec4)));
    std::vector<Binding> of_springs = {constants(), control};
    if (lengths_.any()) of_springs.push_back({BINDING_SPRING_LENGTHS, &lengths_.buffer()});
    ASPIC_TRY(spring_pass_, item_pass(stage_kernels, path_.spring_kernel, std::move(of_springs),
                                      static_cast<std::uint32_t>(spring_count(*model_))));
  }
  if (method_.stages.size() == 1) stage_kernels.defines.push_back({"ASPIC_ONE_STAGE", "1"});
  ASPIC_CHECK(contact_passes_.build(context_, kernels, {constants(), control}));
  if (contact_.any() || options.split_stages) {
    ASPIC_CHECK(build_rest(stage_kernels, {constants(), control, pulls_.binding(), poses_.binding()}));
    // Forces know nothing of terrain and method, so that many scenes share their kernels.
    std::erase_if(stage_kernels.defines, [](const gl::Define& define) {
      constexpr std::string_view of_the_rest[] = {"ASPIC_SHAPES", "ASPIC_ONE_TERRAIN", "ASPIC_MOTION",
                                                  "ASPIC_ONE_STAGE"};
      return std::ranges::find(of_the_rest, define.name) != std::end(of_the_rest);
    });
    stage_kernels.defines.push_back({"ASPIC_BODY_CONTACT", "1"});
  }
  const std::uint32_t by_device = context_.info().is_software ? software_run : 1;
  const std::uint32_t run = options.lattice_run > 0 ? options.lattice_run : by_device;
  if (run > 1) stage_kernels.defines.push_back({"ASPIC_WIDE_LOADS", "1"});
  if (takes_lattices() && has_lattices(*model_))
    ASPIC_CHECK(build_lattice_pass(stage_kernels, run, bindings));
  ASPIC_CHECK(build_cell_passes(stage_kernels, run, bindings));
  if (springs_->listed > 0 || model_->particle_count() == 0) {
    ASPIC_TRY(particle_pass_,
              item_pass(stage_kernels, path_.particle_kernel, std::move(bindings), springs_->listed));
  }
  return balls_.build(context_, *model_, kernels,
                      {&simulation_, &control_, false, poses_.binding(), pulls_.binding()},
                      options.ball_search);
}

/// What follows the forces of springs, and of contact between bodies.
Status ExplicitSolver::build_rest(const KernelOptions& kernels, std::vector<Binding> bindings) {
  ASPIC_TRY(rest_program_, kernels.start("compute/contact_finish.comp"));
  rest_pass_.emplace(*rest_program_, std::move(bindings), ReadBy::compute_pass);
  return {};
}

void ExplicitSolver::queue_rest(const ContactPasses::States& states, std::uint32_t step_index,
                                std::uint32_t stage, ReadBy readers) const {
  rest_program_->set(LOCATION_STEP, step_index);
  rest_program_->set(LOCATION_STAGE, stage);
  const std::array<Binding, 4> bindings = {{{BINDING_START_STATE, states.start},
                                            {BINDING_STAGE_STATE, states.stage},
                                            {BINDING_OUT_STATE, states.out},
                                            {BINDING_STAGE_SUMS, &sums_}}};
  rest_pass_->dispatch_for(model_->particle_count(), bindings, readers);
}

void ExplicitSolver::restart() {
  layout::Control control{};
  control.bad_step = control.bad_particle = control.full_step = NO_STEP;
  control_.upload_items(std::span(&control, 1));
  forget_queues();
  passes_before_ = 0;
  unusable_.reset();
}

void ExplicitSolver::dispatch(const std::optional<ItemPass>& pass, Kind kind,
                              std::span<const Binding> buffers, ReadBy readers) const {
  if (!pass) return;
  pass->dispatch(buffers, readers);
  mark(kind);
}

void ExplicitSolver::queue_step(std::uint32_t step_index, bool last_of_queue) {
  poses_.cover(step_index, 1);
  lengths_.cover(step_index, 1);
  const std::size_t end = (current_ + 1) % 3, between = (current_ + 2) % 3;
  if (contact_.any()) contact_passes_.queue_start(states_[current_], step_index);
  const auto stages = static_cast<std::uint32_t>(method_.stages.size());
  for (const auto* pass : {&spring_pass_, &lattice_pass_, &plain_pass_, &mixed_pass_, &particle_pass_})
    if (*pass) (*pass)->program().set(LOCATION_STEP, step_index);
  std::size_t stage_state = current_;
  for (std::uint32_t s = 0; s < stages; ++s) {
    // Stages alternate between the two free buffers so that the last one lands in `end`.
    const std::size_t out = (stages - 1 - s) % 2 == 0 ? end : between;
    for (const auto* pass : {&lattice_pass_, &plain_pass_, &mixed_pass_, &particle_pass_})
      if (*pass) (*pass)->program().set(LOCATION_STAGE, s);
    if (spring_pass_ && lengths_.any()) spring_pass_->program().set(LOCATION_STAGE, s);
    const ContactPasses::States in_contact = {&states_[current_], &states_[stage_state], &states_[out]};
    if (contact_.any()) contact_passes_.queue_find(in_contact, step_index, time_of(step_index));
    const Binding stage = {BINDING_STAGE_STATE, &states_[stage_state]};
    const std::array<Binding, 6> buffers = {{stage,
                                             {BINDING_START_STATE, &states_[current_]},
                                             {BINDING_OUT_STATE, &states_[out]},
                                             {BINDING_STAGE_SUMS, &sums_},
                                             {BINDING_INCIDENT, &springs_->incident},
                                             {BINDING_SPRING_FORCES, &forces_}}};
    dispatch(spring_pass_, springs_kind,
             std::array<Binding, 3>{
                 {stage, {BINDING_SPRINGS, &springs_->springs}, {BINDING_SPRING_FORCES, &forces_}}},
             ReadBy::compute_pass);
    const bool leaves = last_of_queue && s + 1 == stages && !balls_.any();
    const ReadBy readers = leaves ? anyone : ReadBy::compute_pass;
    // Cubes, cells and all else write different particles: one barrier does for them.
    dispatch(lattice_pass_, lattices_kind, buffers, ReadBy::nobody);
    dispatch(plain_pass_, cells_kind, buffers, ReadBy::nobody);
    dispatch(mixed_pass_, cells_kind, buffers, ReadBy::nobody);
    dispatch(particle_pass_, particles_kind, buffers, ReadBy::nobody);
    gl::barrier(rest_pass_ ? ReadBy(ReadBy::compute_pass) : readers);
    if (contact_.any()) contact_passes_.queue_act(in_contact, step_index);
    if (rest_pass_) queue_rest(in_contact, step_index, s, readers);
    stage_state = out;
  }
  balls_.queue(states_[current_], states_[end], step_index, ball_slot_,
               last_of_queue ? anyone : ReadBy::compute_pass);
  ball_slot_ = 1 - ball_slot_;
  current_ = end;
}

Status ExplicitSolver::carry_out(std::uint64_t steps, bool wait) {
  // Its count of passes is worth nothing any more, nor are its states, which may look like a divergence.
  if (unusable_) return *unusable_;
  while (!divergence_) {
    const bool must = queues_.size() == most_queues || (steps == 0 ? wait : counts_far());
    if (!queues_.empty() && (must || looks_->ready())) {
      const auto undone = take_look();
      if (!undone) {
        forget_queues();
        return undone.error();
      }
      steps += *undone;
    } else if (steps > 0) {
      keep_counting();
      if (!contact_.fresh()) ASPIC_CHECK(contact_.refresh(states_[current_]));
      std::uint64_t worth = depth_.next();
      if (contact_.any()) worth = std::min(worth, contact_.patience());
      steps -= queue_steps(static_cast<std::uint32_t>(std::min(steps, worth)));
    } else {
      break;
    }
  }
  return {};
}

std::uint32_t ExplicitSolver::queue_steps(std::uint32_t count) {
  queues_.push_back({count, current_, ball_slot_, steps_since_, Clock::now()});
  lengths_.cover(steps_since_, count);
  for (std::uint32_t n = 0; n < count; ++n) {
    if (profiler_ && n == 0) profiler_->begin();
    queue_step(steps_since_ + n, n + 1 == count);
    if (profiler_ && n == 0) profiler_->end();
  }
  steps_since_ += count;
  looks_->submit(control_, 0, sizeof(layout::Control));
  return count;
}

/// Waits for the oldest queue and reads its outcome. Returns how many steps have to be queued again.
Result<std::uint64_t> ExplicitSolver::take_look() {
  layout::Control control;
  looks_->take(std::as_writable_bytes(std::span(&control, 1)));
  ASPIC_CHECK(context_.check());
  ASPIC_CHECK(check_overrun(control.overrun));
  const Queue queue = queues_.front();
  queues_.pop_front();
  const auto now = Clock::now();
  depth_.took(queue.count, std::chrono::duration<double>(now - std::max(queue.begun, last_look_)).count());
  last_look_ = now;
  // What is queued behind a step that diverged or found no room has done nothing.
  const bool full = control.full_step != NO_STEP, bad = !full && control.bad_step != NO_STEP;
  const std::uint32_t good = full  ? control.full_step - queue.first_step
                             : bad ? control.bad_step - queue.first_step
                                   : queue.count;
  // A step is found to fail after the last of its passes that count. Unsigned, so that a counter that wraps
  // makes no difference.
  std::uint32_t least = passes_before_ + (good + (full || bad ? 1u : 0u)) * passes_per_step();
  // Balls stay where they are in a step that began with lists that do not hold any more.
  if (full && control.stale != 0) least -= counted_balls();
  if (good > queue.count || control.passes - least > (1u << 31)) {
    unusable_ = idle_device(context_, *model_, least);
    return *unusable_;
  }
  passes_before_ = least;
  if (contact_.any()) contact_.held(good);
  if (!full && !bad) return std::uint64_t{0};
  const std::uint64_t undone = std::uint64_t{steps_since_} - queue.first_step - good;
  current_ = (queue.first_state + good) % 3;
  ball_slot_ = (queue.first_slot + good) % 2;
  steps_since_ = queue.first_step + good;
  forget_queues();
  if (full) {
    // The step is repeated from the state it began with, where nothing was written.
    if (control.stale != 0)
      contact_.forget();
    else
      ASPIC_CHECK(balls_.grow());
    restart();
  } else {
    divergence_ = divergence_from(control.bad_particle, control.bad_step);
  }
  return undone;
}

void ExplicitSolver::forget_queues() {
  queues_.clear();
  looks_->forget();
}

/// Items of a step that count themselves: of each stage springs and particles, and balls in flight.
std::uint32_t ExplicitSolver::passes_per_step() const {
  const auto stages = static_cast<std::uint32_t>(method_.stages.size());
  return stages * counted(model_->particle_count()) +
         (spring_pass_ ? stages * counted(static_cast<std::uint32_t>(spring_count(*model_))) : 0u) +
         counted_balls();
}

Result<std::unique_ptr<GpuSolver>> make_explicit_solver(gl::Context& context, SharedModel model,
                                                        const GpuOptions& options, const ForcePathRow& path) {
  auto solver = std::make_unique<ExplicitSolver>(context, std::move(model), path);
  ASPIC_CHECK(solver->build(options));
  return std::unique_ptr<GpuSolver>(std::move(solver));
}

std::uint64_t explicit_bytes(const ModelCounts& counts, Integrator integrator) {
  const std::uint64_t states = keeps_sums(*free_flight_row(integrator).staged()) ? 4 : 3;
  return states * counts.particles * sizeof(layout::Particle) + sizeof(layout::Control);
}

}  // namespace

const DeviceMethod staged_method = {make_explicit_solver, [](const ForcePathRow&) { return true; },
                                    explicit_bytes, sizeof(layout::Particle), true};

}  // namespace aspic
