#include "playback/figures.h"

#include "base/stopwatch.h"

namespace aspic {
namespace {

/// States that wait to be measured.
constexpr std::size_t most_jobs = 3;

}  // namespace

std::uint64_t Figures::next_step() const {
  return next_sample_step(present_.step(), present_.model().simulation.timestep, stride_);
}

/// Energies are of the same steps in every run, and take a quarter of the time at most. Where they take more,
/// every second one is left out from now on.
bool Figures::begin_reading() {
  const double since_last = seconds_since(last_read_);
  if (jobs_.count() > most_jobs || read_seconds_ > 0.25 * since_last)
    stride_ *= 2;
  else if (stride_ > 1 && read_seconds_ < 0.05 * since_last)
    stride_ /= 2;
  if (jobs_.count() > most_jobs) return false;
  last_read_ = std::chrono::steady_clock::now();
  return true;
}

void Figures::end_reading() {
  read_seconds_ = seconds_since(last_read_);
}

void Figures::measure(const State& state) {
  jobs_.start([this, state](const std::atomic<bool>&) -> Jobs::TakeUp {
    return [this, state, energies = present_.engines().measured(state)] {
      take_up(state, energies);
      return Status();
    };
  });
}

void Figures::take_up(const State& state, const EnergySample& energies) {
  if (timeline_.seeking()) return;
  // States of a backend in the context were kept when they were read: these are older.
  const Engines& engines = present_.engines();
  if (Engines::in_context(engines.leader()) && !engines.shadow_paces())
    samples_.add(energies);
  else
    remember(state, {energies});
}

void Figures::complete() {
  const EnergySample* const known = samples_.nearest(present_.time());
  if (jobs_.idle() && !present_.divergence() && (!known || known->time != present_.time()))
    measure(present_.snapshot());
}

void Figures::remember(const State& state, const std::vector<EnergySample>& energies) {
  timeline_.keep(state);
  for (const EnergySample& sample : energies) samples_.add(sample);
}

}  // namespace aspic
