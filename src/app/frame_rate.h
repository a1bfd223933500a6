#pragma once
// How fast images come.

namespace aspic::app {

class FrameRate {
 public:
  double draw_seconds = 0.0;  ///< how long the last one took [s]

  /// Once for each image of the window, `dt` after the last [s].
  void count(double dt) {
    constexpr double window = 0.5;  // s
    time_ += dt;
    ++images_;
    if (time_ <= window) return;
    per_second_ = images_ / time_;
    time_ = 0.0;
    images_ = 0;
  }
  double per_second() const { return per_second_; }

 private:
  double time_ = 0.0, per_second_ = 0.0;
  int images_ = 0;
};

}  // namespace aspic::app
