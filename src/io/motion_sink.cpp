#include "io/motion_sink.h"

#include <algorithm>
#include <cmath>

#include "base/files.h"
#include "base/printable.h"
#include "io/state_csv.h"
#include "model/model.h"

namespace aspic {
namespace {

constexpr double default_interval = 0.02;  // [s]

}  // namespace

std::uint64_t MotionSink::next_step(std::uint64_t step) const {
  if (samples_ == 0) return step + 1;
  const std::uint64_t begun = raster_ == Raster::even ? step - first_ : step;
  return step + (interval_ - begun % interval_);
}

/// Steps of times that are rounded to them are unevenly apart by one.
bool MotionSink::is_even(std::uint64_t step) const {
  if (raster_ == Raster::multiples || samples_ < 2) return true;
  const std::uint64_t apart = step - last_;
  return apart + 1 >= spacing_ && apart <= spacing_ + 1;
}

Status MotionSink::take(const Sample& sample) {
  const std::uint64_t step = sample.state.step;
  if (samples_ == 0) {
    const double steps = std::round(default_interval / sample.model.simulation.timestep);
    interval_ = every() > 0 ? every() : static_cast<std::uint64_t>(std::clamp(steps, 1.0, 1e15));
    first_ = step;
  } else if (step == last_) {
    return {};
  }
  if (step < last_ || !is_even(step))
    return fail(ErrorCode::usage,
                "{} needs samples at equal intervals, and the interval from step {} to step {} differs from "
                "those before it.",
                printable_line(path()), step, last_);
  ASPIC_CHECK(check_finite(sample.state, path()));
  ASPIC_CHECK(add(sample));
  if (samples_ == 1) spacing_ = step - last_;
  ++samples_;
  last_ = step;
  return {};
}

Status MotionSink::finish(const Sample& last) {
  const std::uint64_t wanted = samples_ > 1 ? spacing_ : interval_;
  if (raster_ == Raster::multiples || samples_ == 0 || last.state.step == last_ + wanted)
    ASPIC_CHECK(take(last));
  return complete(last);
}

Status check_export_name(const std::string& path) {
  if (!is_device_or_pipe(path)) return {};
  return fail(ErrorCode::usage, "{} is a device or a pipe, and a motion needs files: name a file.",
              printable_line(path));
}

}  // namespace aspic
