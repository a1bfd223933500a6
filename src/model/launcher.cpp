#include "model/launcher.h"

#include <cmath>
#include <limits>

#include "base/split_mix.h"
#include "model/bodies.h"

namespace aspic {
namespace {

Vec3 point_in(const BoxSettings& box, std::int64_t seed, std::uint64_t first) {
  Vec3 point;
  for (int axis = 0; axis < 3; ++axis) {
    const double share = launcher_number(seed, first + static_cast<std::uint64_t>(axis));
    point[axis] = box.min[axis] + share * (box.max[axis] - box.min[axis]);
  }
  return point;
}

/// round(n·interval/h), and the largest number there is where that exceeds all step numbers.
std::uint64_t launch_step(std::uint64_t n, double interval, double timestep) {
  const double step = std::round(static_cast<double>(n) * interval / timestep);
  return step < 0x1p64 ? static_cast<std::uint64_t>(step) : std::numeric_limits<std::uint64_t>::max();
}

}  // namespace

double launcher_number(std::int64_t seed, std::uint64_t index) {
  const std::uint64_t start = SplitMix64::mix(static_cast<std::uint64_t>(seed));
  const std::uint64_t bits = SplitMix64::mix(start + (index + 1) * SplitMix64::gamma);
  return static_cast<double>(bits >> 11) * 0x1p-53;
}

Ball launched_ball(const LauncherSettings& launcher, std::uint64_t n, double timestep) {
  const Vec3 start = point_in(launcher.from, launcher.seed, 6 * n);
  const Vec3 target = point_in(launcher.towards, launcher.seed, 6 * n + 3);
  Ball ball;
  ball.radius = launcher.ball.radius;
  ball.mass = launcher.ball.mass;
  ball.launch_step = launch_step(n, launcher.interval, timestep);
  ball.initial_position = start;
  ball.initial_velocity = launcher.speed_factor * (target - start);
  return ball;
}

BodyRow row_of(const LauncherSettings&) {
  constexpr auto counts = [](const LauncherSettings& launcher) {
    ModelCounts all;
    all.balls = static_cast<std::uint64_t>(launcher.count);
    return all;
  };
  constexpr auto add = [](Model& model, const LauncherSettings& launcher) -> Status {
    for (int n = 0; n < launcher.count; ++n)
      model.balls.push_back(
          launched_ball(launcher, static_cast<std::uint64_t>(n), model.simulation.timestep));
    return {};
  };
  return body_row<&ModelSettings::launchers, counts, add>("launcher", "count");
}

}  // namespace aspic
