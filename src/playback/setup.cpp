#include "playback/setup.h"

#include <cassert>

namespace aspic {

Result<Model> build_model(const Setup& setup) {
  auto model = build_model(setup.settings);
  if (!model) return model;
  for (const auto& [particle, pinned] : setup.pinned) {
    if (particle < model->particle_count())
      model->inverse_mass.set(particle, pinned ? 0.0 : 1.0 / model->mass[particle]);
  }
  model->balls.insert(model->balls.end(), setup.thrown.begin(), setup.thrown.end());
  return model;
}

State grown_state(const Model& model, State state) {
  assert(state.position.size() == model.particle_count());
  for (std::size_t b = state.ball_position.size(); b < model.balls.size(); ++b) {
    const Ball& ball = model.balls[b];
    state.ball_position.push_back(ball.initial_position);
    state.ball_velocity.push_back(ball.initial_velocity);
    state.ball_angular_velocity.push_back(ball.initial_angular_velocity);
  }
  for (std::size_t i = 0; i < state.velocity.size(); ++i) {
    if (model.inverse_mass[i] == 0.0) state.velocity[i] = {};
  }
  return state;
}

}  // namespace aspic
