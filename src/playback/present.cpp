#include "playback/present.h"

#include "base/stopwatch.h"
#include "gpu_solver/gpu_solver.h"
#include "run/window_host.h"

namespace aspic {

std::optional<DeviceState> Present::device_state() const {
  const GpuSolver* const gpu = gpu_of(engines_.leader());
  if (!gpu) return std::nullopt;
  return gpu->device_state();
}

double Present::snapshot_age() const {
  return seconds_since(snapshot_time_);
}

Status Present::install(Setup setup, Result<Engines> engines) {
  if (!engines) return engines.error();
  engines_ = std::move(*engines);
  if (engines_.departure) message_ = engines_.departure;
  setup_ = std::move(setup);
  ++model_number_;
  return {};
}

Status Present::set_constants(Setup setup, SharedModel model) {
  ASPIC_CHECK(engines_.set_constants(std::move(model)));
  setup_ = std::move(setup);
  ++model_number_;
  return {};
}

Status Present::load(const State& state) {
  ASPIC_CHECK(engines_.load(state));
  take_snapshot(State(state));
  step_ = state.step;
  divergence_.reset();
  ++image_number_;
  return {};
}

void Present::take_snapshot(State state) {
  snapshot_ = std::move(state);
  snapshot_time_ = std::chrono::steady_clock::now();
}

void Present::advance(std::uint64_t steps) {
  step_ += steps;
  if (steps > 0) ++image_number_;
}

}  // namespace aspic
