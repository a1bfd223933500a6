#include "model/launcher.h"

#include <cmath>
#include <limits>

namespace aspic {
namespace {

std::uint64_t mix(std::uint64_t z) {
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
  return z ^ (z >> 31);
}

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
  constexpr std::uint64_t gamma = 0x9e3779b97f4a7c15ull;
  const std::uint64_t bits = mix(mix(static_cast<std::uint64_t>(seed)) + (index + 1) * gamma);
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

Status add_launcher(Model& model, const LauncherSettings& launcher) {
  for (int n = 0; n < launcher.count; ++n) {
    model.balls.push_back(launched_ball(launcher, static_cast<std::uint64_t>(n), model.simulation.timestep));
  }
  return {};
}

}  // namespace aspic
