#include "playback/pacer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace aspic {

std::string slowness(double factor, int particles_per_edge) {
  constexpr double slow = 0.05, quick = 0.5;  // × real time
  if (factor <= 0.0 || factor >= slow) return "the solver does not keep up";
  const double wait = 1.0 / factor;  // s
  std::string text = wait < 90.0 ? fmt::format("1 s takes about {:.0f} s here", wait)
                                 : fmt::format("1 s takes about {:.0f} min here", std::ceil(wait / 60.0));
  // Work grows with the third power.
  const int fewer = static_cast<int>(particles_per_edge * std::cbrt(factor / quick));
  if (fewer >= 4) text += fmt::format("; try {} particles an edge", fewer);
  return text;
}

void Pacer::set_speed(double speed) {
  const double before = std::exchange(speed_, std::clamp(speed, slowest_speed, fastest_speed));
  video_is_behind_ = video_is_behind_ || speed_ != before;
}

void Pacer::drop_due() {
  due_ = 0.0;
  video_is_behind_ = true;
}

void Pacer::restart() {
  due_ = 0.0;
  behind_ = false;
  since_behind_ = std::numeric_limits<double>::infinity();
  rate_start_ = Clock::now();
  rate_steps_ = 0;
  steps_per_second_ = 0.0;
}

std::optional<std::uint64_t> Pacer::limit() const {
  std::optional<std::uint64_t> least;
  for (const auto& step : limits_)
    if (step && (!least || *step < *least)) least = step;
  return least;
}

std::uint64_t Pacer::steps_due(double dt, const SimulationSettings& settings, std::uint64_t step) {
  const std::optional<std::uint64_t> end = limit();
  const std::uint64_t left = end && *end > step ? *end - step : 0;
  if (catches_up_) return left;
  constexpr double rate_window = 0.5;  // s
  const double asked =
      pace_ == Pace::real_time ? speed_ * dt / settings.timestep : speed_ * settings.steps_per_frame;
  due_ += asked;
  // What was not done within two images or a tenth of a second is dropped: the motion slows down, and does
  // not jump.
  const double tenth = pace_ == Pace::real_time ? speed_ * 0.1 / settings.timestep : 0.0;
  const double most = std::max({2.0 * asked, tenth, 1.0});
  behind_ = due_ > most;
  since_behind_ = behind_ ? 0.0 : since_behind_ + dt;
  due_ = std::min(due_, most);
  if (const double window = std::chrono::duration<double>(Clock::now() - rate_start_).count();
      window > rate_window) {
    steps_per_second_ = static_cast<double>(rate_steps_) / window;
    rate_start_ = Clock::now();
    rate_steps_ = 0;
  }
  const auto steps = static_cast<std::uint64_t>(due_);
  // A video sees each state that the run is put to, and each speed, before the run goes on.
  const bool recorded = limits_[static_cast<std::size_t>(Hold::video)].has_value();
  if (std::exchange(video_is_behind_, false) && recorded) return 0;
  return end ? std::min(steps, left) : steps;
}

void Pacer::did(std::uint64_t steps) {
  rate_steps_ += steps;
  due_ = std::max(due_ - static_cast<double>(steps), 0.0);
}

}  // namespace aspic
