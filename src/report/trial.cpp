#include "report/trial.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <ctime>

#include "model/steps.h"

namespace aspic::report {

TrialResult trial_error(const Error& error) {
  const bool refused = error.code == ErrorCode::usage || error.code == ErrorCode::scene_rejected;
  TrialResult result;
  result.outcome = refused ? Outcome::rejected : Outcome::failed;
  const std::string text = worded(error, FrontEnd::command_line);
  result.reason = text.substr(0, text.find('\n'));
  return result;
}

double thread_time() {
  timespec now = {};
  ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

Result<TrialResult> run_trial(SharedModel shared_model, const TrialOptions& options) {
  const Model& model = *shared_model;
  const auto steps = steps_of(options.length, model.simulation);
  if (!steps) return trial_error(steps.error());
  auto backend = make_backend(options.backend, shared_model);
  if (!backend) return trial_error(backend.error());
  Solver& solver = *backend->solver;
  const double h = model.simulation.timestep;
  const std::uint64_t stride = sample_stride(h, options.interval);

  TrialResult result;
  result.solver = backend->variant();
  Course course(model);
  std::uint64_t step = 0;
  std::optional<Divergence> divergence;
  for (;;) {
    auto state = solver.state();
    if (!state) return trial_error(state.error());
    course.take(*state);
    while (result.images.size() < options.image_times.size() &&
           static_cast<double>(step) * h >= options.image_times[result.images.size()] - 0.5 * h)
      result.images.push_back(*state);
    if (step == *steps || divergence) {
      result.steps = state->step;
      result.hash = state_hash_text(*state);
      break;
    }
    if (options.stop && options.stop()) return Error{ErrorCode::interrupted, "interrupted."};
    std::uint64_t next = std::min(*steps, step + stride);
    if (result.images.size() < options.image_times.size()) {
      const std::uint64_t wanted = nearest_step(options.image_times[result.images.size()], h);
      if (wanted > step) next = std::min(next, wanted);
    }
    const auto before = std::chrono::steady_clock::now();
    const double thread_before = thread_time();
    auto advanced = solver.advance(next - step);
    result.seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - before).count();
    result.thread_seconds += thread_time() - thread_before;
    if (!advanced) return trial_error(advanced.error());
    divergence = advanced->divergence;
    step = next;
  }
  if (divergence) {
    result.outcome = Outcome::diverged;
    result.reason =
        fmt::format("{} {} in step {}", body_text(*divergence), fault_text(*divergence), divergence->step);
  }
  result.summary = course.summary();
  result.samples = course.samples();
  return result;
}

}  // namespace aspic::report
