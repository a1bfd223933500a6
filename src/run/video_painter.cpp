#include "run/video_painter.h"

#include <chrono>
#include <utility>

#include "base/stopwatch.h"

namespace aspic {

Result<std::unique_ptr<VideoPainter>> VideoPainter::create(gl::Context& context, const ImageOutput& output,
                                                           std::vector<RenderedRun> runs,
                                                           std::vector<std::unique_ptr<FrameSink>> sinks) {
  std::unique_ptr<VideoPainter> v(new VideoPainter(context));
  ASPIC_TRY(v->painter_, FramePainter::create(context, output.size, std::move(runs)));
  VideoOptions video = {sinks.front()->path(), frames_per_second(output), output.size};
  ASPIC_TRY(v->recording_, Recording::start(context, std::move(sinks), std::move(video)));
  return v;
}

FrameTimes VideoPainter::times() const {
  FrameTimes times = recording_->times();
  times.draw = draw_seconds_;
  return times;
}

Status VideoPainter::add(const std::vector<RenderedState>& states, const std::vector<RunView>& views,
                         std::uint64_t copies) {
  recording_->wait_until_ready();
  // Only an error completes the recording before its end.
  if (recording_->completed()) return recording_->result();
  const auto before = std::chrono::steady_clock::now();
  std::vector<DeviceState> there;
  for (std::size_t i = 0; i < states.size(); ++i) {
    if (states[i].there.particles) {
      there.push_back(states[i].there);
    } else {
      ASPIC_TRY(const auto state, upload(painter_->renderer(i), *states[i].solver));
      there.push_back(state);
    }
  }
  ASPIC_CHECK(painter_->draw(there, views));
  draw_seconds_ += seconds_since(before);
  return recording_->add(painter_->frame(), copies);
}

Status VideoPainter::finish() {
  ASPIC_CHECK(recording_->end_complete());
  return recording_->result();
}

}  // namespace aspic
