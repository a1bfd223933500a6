#pragma once
// How fast pictures come.

namespace aspic::app {

class PictureRate {
 public:
  double draw_seconds = 0.0;  ///< how long the last one took [s]

  /// Once for each picture of the window, `dt` after the last [s].
  void count(double dt) {
    constexpr double window = 0.5;  // s
    time_ += dt;
    ++pictures_;
    if (time_ <= window) return;
    per_second_ = pictures_ / time_;
    time_ = 0.0;
    pictures_ = 0;
  }
  double per_second() const { return per_second_; }

 private:
  double time_ = 0.0, per_second_ = 0.0;
  int pictures_ = 0;
};

}  // namespace aspic::app
