// A backend as a contestant of `aspic bench`.
#include <algorithm>
#include <ctime>
#include <utility>

#include "cli/bench.h"
#include "model/integrator.h"
#include "model/springs.h"
#include "run/window_host.h"

namespace aspic::cli {
namespace {

/// Time after which a run looks whether it was interrupted [s].
constexpr double patience = 0.1;

class BackendContestant final : public Contestant {
 public:
  BackendContestant(Measurement measurement, Backend backend, const InterruptGuard& interrupt)
      : Contestant(std::move(measurement)), backend_(std::move(backend)), interrupt_(interrupt) {}

  Result<Took> run(std::uint64_t steps) override {
    ASPIC_CHECK(make_current());
    Solver& solver = *backend_.solver;
    ASPIC_CHECK(solver.load(initial_state(solver.model(), solver.precision())));
    const auto start = Clock::now();
    const std::clock_t processor_start = std::clock();
    for (std::uint64_t done = 0; done < steps && !m.divergence;) {
      if (interrupt_.interrupted()) return Error{ErrorCode::interrupted, ""};
      const auto before = Clock::now();
      const std::uint64_t count = std::min(at_once_, steps - done);
      ASPIC_TRY(const Advance advanced, solver.advance(count));
      m.divergence = advanced.divergence;
      done += count;
      if (count == at_once_ && seconds_since(before) < patience) at_once_ *= 2;
    }
    ASPIC_CHECK(wait());
    const Took took = {seconds_since(start),
                       static_cast<double>(std::clock() - processor_start) / CLOCKS_PER_SEC};
    if (const auto solves = solver.solve_statistics()) {
      // A residual at the start of the step and after each Newton iteration, and an application of the
      // Jacobian in each conjugate gradient iteration.
      const auto iterations = static_cast<double>(solves->newton_iterations + solves->cg_iterations);
      m.evaluations_per_step = 1.0 + iterations / static_cast<double>(steps);
    }
    return took;
  }

  /// Device time by pass, from separate steps, so that the time stamps do not disturb the measurement.
  Status finish() override {
    GpuSolver* const gpu = gpu_of(backend_);
    if (!gpu) return {};
    ASPIC_CHECK(make_current());
    gpu->set_profiling(true);
    // The other contestants' work was between: the device's clocks rise again.
    ASPIC_TRY(const Advance warmed, backend_.solver->advance(std::min(at_once_, m.steps)));
    m.divergence = warmed.divergence;
    const auto start = Clock::now();
    for (std::size_t n = 0; n < gl::PassProfiler::window && (n == 0 || seconds_since(start) < 1.0); ++n) {
      if (interrupt_.interrupted()) break;
      ASPIC_TRY(const Advance advanced, backend_.solver->advance(1));
      m.divergence = advanced.divergence;
      // So that every step finds a free place for its time stamps.
      ASPIC_CHECK(wait());
    }
    m.passes = gpu->pass_times();
    gpu->set_profiling(false);
    return {};
  }

 private:
  /// Until the device is done: no field is read.
  Status wait() {
    ASPIC_TRY([[maybe_unused]] const auto step, backend_.solver->read_into({}));
    return {};
  }
  /// Solvers enter their context themselves; so the change is none of what is measured.
  Status make_current() {
    gl::Context* const context = context_of(backend_);
    return context ? context->make_current() : Status();
  }

  Backend backend_;
  const InterruptGuard& interrupt_;
  std::uint64_t at_once_ = 1;
};

}  // namespace

Result<std::unique_ptr<Contestant>> make_backend_contestant(const BackendChoice& choice,
                                                            const SharedModel& shared_model,
                                                            const InterruptGuard& interrupt) {
  ASPIC_TRY(auto backend, make_backend(choice, shared_model));
  return make_backend_contestant(std::move(backend), interrupt);
}

std::unique_ptr<Contestant> make_backend_contestant(Backend backend, const InterruptGuard& interrupt) {
  const Model& model = backend.solver->model();
  Measurement m;
  m.name = backend.variant();
  m.backend = backend.row->name;
  m.force_path = backend.force_path;
  m.arithmetic = backend.arithmetic;
  m.device = backend.device;
  m.integrator = model.simulation.integrator;
  m.particles = model.particle_count();
  m.springs = spring_count(model);
  m.bytes = backend.solver->bytes();
  m.timestep = model.simulation.timestep;
  m.evaluations_per_step = force_evaluations_per_step(m.integrator);
  return std::make_unique<BackendContestant>(std::move(m), std::move(backend), interrupt);
}

}  // namespace aspic::cli
