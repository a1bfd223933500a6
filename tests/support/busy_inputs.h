#pragma once
// Inputs of every kind for runs in which solvers are compared bit by bit.
#include <cstdint>
#include <vector>

#include "aspic/inputs.h"

namespace aspic::test {

/// Every `steps` steps others, five in all: pulls on one particle and elsewhere, on balls where there are
/// any, pins that come and go, the scene's pins released, nothing.
inline InputLog busy_inputs(const Model& model, std::uint64_t steps) {
  const std::uint32_t last = model.particle_count() - 1;
  const Vec3 near = model.initial_position[0], far = model.initial_position[last];
  InputLog log;
  log.set(0, {.pulls = {{last, far + Vec3{0.5, 1.0, 0.2}, 300.0, 2.0},
                        {0, near + Vec3{-0.3, 0.7, 1.0 / 3.0}, 1e3 / 3.0, 1.0},
                        {last, far + Vec3{-0.7, 0.4, 0.0}, 200.0, 0.0}},
              .channels = {0.5}});
  Inputs second = {.pulls = {{last / 2, near, 150.0, 1.0}}};
  if (model.ball_count() > 0) {
    const std::uint32_t ball = model.ball_count() - 1;
    second.pulls.push_back({ball, model.balls[ball].initial_position + Vec3{0.0, 1.0, 0.0}, 40.0, 0.5, true});
    second.pulls.push_back({ball, far, 30.0, 0.0, true});
  }
  log.set(steps, second);
  Inputs third = {.pulls = {{last, far, 300.0, 2.0}, {0, near, 80.0, 0.0}}, .pinned = {last, last / 3}};
  for (std::uint32_t i = 0; i < last / 3; ++i)
    if (model.inverse_mass[i] == 0.0) third.released.push_back(i);
  log.set(2 * steps, third);
  log.set(3 * steps, {.pinned = {last / 3, 1}});
  log.set(4 * steps, {});
  return log;
}

}  // namespace aspic::test
