#pragma once
// How fast simulated time passes, and how fast it really does.
#include <algorithm>
#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>

#include "aspic/settings.h"

namespace aspic {

enum class Pace {
  steps_per_frame,  ///< the scene's steps for each image, whatever time that takes
  real_time         ///< as much simulated time as passes outside
};
inline constexpr double slowest_speed = 1.0 / 1024.0, fastest_speed = 1024.0;

/// What to say of a run that comes to `factor` × real time where more was asked for. Where that is hopeless:
/// how long a second takes, and how many particles along the edge of a cube (0: there is none) would do.
std::string slowness(double factor, int particles_per_edge);

/// Who may have a run wait.
enum class Hold {
  video,       ///< wants its image first
  encoder,     ///< has no room for another image
  comparison,  ///< others are to catch up; or it is the run's own goal, see Pacer::catch_up()
};
inline constexpr std::size_t hold_count = 3;

class Pacer {
 public:
  Pace pace() const { return pace_; }
  void set_pace(Pace pace) { pace_ = pace; }
  /// Factor on the pace, slowest_speed … fastest_speed; others are clamped.
  double speed() const { return speed_; }
  void set_speed(double speed);

  /// A step that the run does not pass, however far the pace has come; nothing: this one holds it no longer.
  void limit(Hold source, std::optional<std::uint64_t> step) {
    limits_[static_cast<std::size_t>(source)] = step;
  }
  /// The least of all limits; nothing if there is none.
  std::optional<std::uint64_t> limit() const;
  /// The run follows another: it goes to its limit as soon as can be, whatever the pace, and without one
  /// nowhere.
  void catch_up(bool on) { catches_up_ = on; }

  /// The run was started or paused: counts from now on.
  void restart();
  /// The run was put to another state: no step is owed.
  void drop_due();
  /// Once for each image, `dt` after the last [s]: the steps to do next, of a run that is at `step`.
  std::uint64_t steps_due(double dt, const SimulationSettings& settings, std::uint64_t step);
  void did(std::uint64_t steps);
  /// Fewer steps were done than the pace asks for.
  bool behind() const { return behind_; }
  /// So it was lately.
  bool late() const { return since_behind_ < 3.0; }
  /// Measured while running; 0 before there is a measurement.
  double steps_per_second() const { return steps_per_second_; }
  /// It was late lately, and a run at `factor` × real time lacks more than a measurement may err.
  bool falls_short(double factor) const {
    return late() && factor > 0.0 && (pace_ != Pace::real_time || factor < 0.97 * speed_);
  }

 private:
  using Clock = std::chrono::steady_clock;
  Pace pace_ = Pace::real_time;
  double speed_ = 1.0;
  std::array<std::optional<std::uint64_t>, hold_count> limits_;
  bool catches_up_ = false;
  bool video_is_behind_ = false;  // its limit is of another state, or of another speed
  bool behind_ = false;
  double since_behind_ = std::numeric_limits<double>::infinity();  // [s]
  double due_ = 0.0;                                               // steps asked for and not done
  Clock::time_point rate_start_ = Clock::now();
  std::uint64_t rate_steps_ = 0;
  double steps_per_second_ = 0.0;
};

}  // namespace aspic
