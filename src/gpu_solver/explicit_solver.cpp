#include "gpu_solver/explicit_solver.h"

#include <algorithm>
#include <array>

#include "gpu_solver/device_solver.h"
#include "model/integrator.h"
#include "model/springs.h"

namespace aspic {
namespace {

using gl::Binding;
using gl::Buffer;
using gl::ReadBy;

/// Steps queued between two looks at the control words: enough to hide the wait, few enough to answer Ctrl-C.
constexpr std::uint64_t steps_per_look = 256;

/// Whether the method's sums outlive a stage, so that memory must hold them.
bool keeps_sums(const IntegratorRow& method) {
  return std::any_of(method.stages.begin(), method.stages.end() - 1,
                     [](const Stage& s) { return s.weight != 0.0; });
}

class ExplicitSolver final : public DeviceSolver {
 public:
  // The step's start, its end, and a place for stages in between; the roles rotate with every step.
  ExplicitSolver(gl::Context& context, const Model& model, const ForcePathRow& path)
      : DeviceSolver(context, model, path, 3,
                     {std::string(path.spring_title), std::string(path.particle_title)}),
        method_(free_flight_row(model.simulation.integrator)) {}

  Result<std::optional<Divergence>> advance(std::uint64_t steps) override;

 private:
  /// Kinds of passes, for the profiler.
  enum Kind : std::size_t { springs_kind, particles_kind };
  std::uint32_t group_size(const GpuOptions& options) const override { return options.group_size; }
  Status build_passes(const KernelOptions& kernels, const GpuOptions& options) override;
  void restart() override;
  void queue_step(std::uint32_t step_index, bool last_of_queue);
  Result<layout::Control> read_control();

  const IntegratorRow& method_;
  Buffer sums_, control_, forces_;
  std::optional<gl::Pass> spring_pass_, particle_pass_;  // of each stage
};

Status ExplicitSolver::build_passes(const KernelOptions& kernels, const GpuOptions& options) {
  const std::uint64_t state_bytes = states_[0].bytes();
  ASPIC_TRY(sums_, Buffer::create(context_, "stage sums", keeps_sums(method_) ? state_bytes : 0));
  ASPIC_TRY(control_, Buffer::create(context_, "control words", sizeof(layout::Control)));
  const Binding control = {BINDING_CONTROL, &control_};
  std::vector<Binding> bindings = {constants(),
                                   control,
                                   pull_.binding(),
                                   poses_.binding(),
                                   {BINDING_STAGE_SUMS, &sums_},
                                   {BINDING_INCIDENT_START, &springs_->incident_start},
                                   {BINDING_INCIDENT, &springs_->incident}};
  if (!path_.spring_kernel.empty()) {
    ASPIC_TRY(forces_,
              Buffer::create(context_, "spring forces", spring_count(model_) * sizeof(layout::vec4)));
    bindings.push_back({BINDING_SPRING_FORCES, &forces_});
    ASPIC_TRY(spring_pass_, pass(kernels, path_.spring_kernel,
                                 {constants(),
                                  control,
                                  {BINDING_SPRINGS, &springs_->springs},
                                  {BINDING_SPRING_FORCES, &forces_}}));
  }
  ASPIC_TRY(particle_pass_, pass(kernels, path_.particle_kernel, std::move(bindings)));
  return balls_.build(context_, model_, kernels, {&simulation_, &control_, false, poses_.binding()},
                      options.ball_search);
}

void ExplicitSolver::restart() {
  const layout::Control control = {NO_STEP, NO_STEP, NO_STEP, 0};
  control_.upload_items(std::span<const layout::Control>(&control, 1));
}

void ExplicitSolver::queue_step(std::uint32_t step_index, bool last_of_queue) {
  poses_.cover(step_index, 1);
  const std::size_t end = (current_ + 1) % 3, between = (current_ + 2) % 3;
  const auto stages = static_cast<std::uint32_t>(method_.stages.size());
  if (spring_pass_) spring_pass_->program().set(LOCATION_STEP, step_index);
  particle_pass_->program().set(LOCATION_STEP, step_index);
  std::size_t stage_state = current_;
  for (std::uint32_t s = 0; s < stages; ++s) {
    // Stages alternate between the two free buffers so that the last one lands in `end`.
    const std::size_t out = (stages - 1 - s) % 2 == 0 ? end : between;
    particle_pass_->program().set(LOCATION_STAGE, s);
    const std::array<Binding, 3> states = {{{BINDING_STAGE_STATE, &states_[stage_state]},
                                            {BINDING_START_STATE, &states_[current_]},
                                            {BINDING_OUT_STATE, &states_[out]}}};
    if (spring_pass_) {
      spring_pass_->dispatch_for(static_cast<std::uint32_t>(spring_count(model_)),
                                 std::span(states).first(1));
      mark(springs_kind);
    }
    const bool leaves = last_of_queue && s + 1 == stages && !balls_.any();
    particle_pass_->dispatch_for(model_.particle_count(), states, leaves ? anyone : ReadBy::compute_pass);
    mark(particles_kind);
    stage_state = out;
  }
  balls_.queue(states_[current_], states_[end], step_index, ball_slot_,
               last_of_queue ? anyone : ReadBy::compute_pass);
  ball_slot_ = 1 - ball_slot_;
  current_ = end;
}

Result<std::optional<Divergence>> ExplicitSolver::advance(std::uint64_t steps) {
  while (steps > 0 && !divergence_) {
    keep_counting();
    const auto queue = static_cast<std::uint32_t>(std::min(steps, steps_per_look));
    const std::size_t first_state = current_;
    const std::uint32_t first_slot = ball_slot_;
    for (std::uint32_t n = 0; n < queue; ++n) {
      if (profiler_ && n == 0) profiler_->begin();
      queue_step(steps_since_ + n, n + 1 == queue);
      if (profiler_ && n == 0) profiler_->end();
    }
    ASPIC_TRY(const layout::Control control, read_control());
    std::uint32_t good = queue;
    if (control.full_step != NO_STEP) {
      // Steps before it have passed; it is repeated from the state it began with, where nothing was written.
      good = control.full_step - steps_since_;
      ASPIC_CHECK(balls_.grow());
      restart();
    } else if (control.bad_step != NO_STEP) {
      good = control.bad_step - steps_since_;
      divergence_ = divergence_from(control.bad_particle, control.bad_step);
    }
    current_ = (first_state + good) % 3;
    ball_slot_ = (first_slot + good) % 2;
    steps_since_ += good;
    steps -= good;
  }
  return divergence_;
}

Result<layout::Control> ExplicitSolver::read_control() {
  const layout::Control control = control_.download_items<layout::Control>(1).front();
  ASPIC_CHECK(context_.check());
  ASPIC_CHECK(check_overrun(control.overrun));
  return control;
}

}  // namespace

Result<std::unique_ptr<GpuSolver>> make_explicit_solver(gl::Context& context, const Model& model,
                                                        const GpuOptions& options, const ForcePathRow& path) {
  auto solver = std::make_unique<ExplicitSolver>(context, model, path);
  ASPIC_CHECK(solver->build(options));
  return std::unique_ptr<GpuSolver>(std::move(solver));
}

std::uint64_t explicit_bytes(const ModelCounts& counts, Integrator integrator) {
  const std::uint64_t states = keeps_sums(free_flight_row(integrator)) ? 4 : 3;
  return states * counts.particles * sizeof(layout::Particle) + sizeof(layout::Control);
}

}  // namespace aspic
