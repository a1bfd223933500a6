#include "analysis/energy.h"

#include <algorithm>
#include <cassert>
#include <limits>

namespace aspic {

Measures measure(const Model& model, const State& state) {
  assert(state.position.size() == model.mass.size());
  Measures m;
  double fastest_squared = 0.0;
  double lowest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < model.mass.size(); ++i) {
    m.gravitational -= model.mass[i] * dot(model.simulation.gravity, state.position[i]);
    lowest = std::min(lowest, state.position[i].y);
    if (model.inverse_mass[i] == 0.0) continue;
    const double speed_squared = dot(state.velocity[i], state.velocity[i]);
    m.kinetic += 0.5 * model.mass[i] * speed_squared;
    m.momentum = m.momentum + model.mass[i] * state.velocity[i];
    fastest_squared = std::max(fastest_squared, speed_squared);
  }
  m.max_speed = std::sqrt(fastest_squared);
  if (!model.mass.empty()) m.min_height = lowest;
  for (const Spring& spring : model.springs) {
    const SpringClass& c = model.spring_classes[spring.spring_class];
    const double stretch = length(state.position[spring.a] - state.position[spring.b]) - c.rest_length;
    if (c.cord && stretch < 0.0) continue;
    m.elastic += 0.5 * c.stiffness * stretch * stretch;
  }
  return m;
}

}  // namespace aspic
