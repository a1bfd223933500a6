#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "aspic/analysis.h"
#include "collision/contact_search.h"
#include "model/counts.h"
#include "model/springs.h"
#include "physics/springs/law.h"

namespace aspic {

struct Meter::Parts {
  using Contact = collision::ContactSearch<double>;
  const Model& model;
  std::optional<Contact> contact;  // from the first state on, where bodies touch

  /// The elastic energy of contacts between bodies [J].
  double contact_energy(const State& state) {
    if (!contact) contact.emplace(model);
    const auto x = physics::field<double>(state.position), v = physics::field<double>(state.velocity);
    const Contact::Particles at = {physics::components(x.data()), physics::components(v.data()), 3};
    return contact->begin_step(state.step, at) && contact->find(at) ? contact->energy() : 0.0;
  }
};

Meter::Meter(const Model& model) : parts_(new Parts{model, {}}) {}
Meter::Meter(Meter&&) noexcept = default;
Meter::~Meter() = default;

double Measures::total() const {
  return kinetic + elastic + gravitational;
}

Measures measure_motion(const Model& model, const State& state) {
  assert(check_sizes(model, state));
  Measures m;
  const double drag = model.simulation.drag;
  double fastest_squared = 0.0, resisted = 0.0;  // Σ m v²
  double lowest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < model.mass.size(); ++i) {
    m.gravitational -= model.mass[i] * dot(model.simulation.gravity, state.position[i]);
    lowest = std::min(lowest, state.position[i].y);
    const double speed_squared = dot(state.velocity[i], state.velocity[i]);
    m.kinetic += 0.5 * model.mass[i] * speed_squared;
    resisted += model.mass[i] * speed_squared;
    m.momentum = m.momentum + model.mass[i] * state.velocity[i];
    fastest_squared = std::max(fastest_squared, speed_squared);
  }
  for (std::size_t b = 0; b < model.balls.size(); ++b) {
    const Ball& ball = model.balls[b];
    if (!ball.launched(state.step)) continue;
    const Vec3 &v = state.ball_velocity[b], &omega = state.ball_angular_velocity[b];
    m.gravitational -= ball.mass * dot(model.simulation.gravity, state.ball_position[b]);
    m.kinetic += 0.5 * ball.mass * dot(v, v) + 0.5 * ball.inertia() * dot(omega, omega);
    m.momentum = m.momentum + ball.mass * v;
    resisted += ball.mass * dot(v, v);
    lowest = std::min(lowest, state.ball_position[b].y);
    fastest_squared = std::max(fastest_squared, dot(v, v));
  }
  m.max_speed = std::sqrt(fastest_squared);
  if (drag > 0.0) m.drag_power = drag * resisted;
  if (std::isfinite(lowest)) m.min_height = lowest;
  return m;
}

Measures Meter::measure(const State& state, const Inputs& inputs) {
  const Model& model = parts_->model;
  Measures m = measure_motion(model, state);
  const std::vector<double> r = rest_lengths(model, state.step, 0.0, inputs.channels);
  std::vector<physics::SpringConstants<double>> classes(model.spring_classes.begin(),
                                                        model.spring_classes.end());
  for (std::size_t n = 0; n < classes.size(); ++n) classes[n].r = r[n];
  for (const Spring& spring : springs_of(model))
    m.elastic += physics::spring_energy(classes[spring.spring_class],
                                        length(state.position[spring.a] - state.position[spring.b]));
  if (has_body_contact(model)) {
    m.contact = parts_->contact_energy(state);
    m.elastic += *m.contact;
  }
  return m;
}

Measures measure(const Model& model, const State& state, const Inputs& inputs) {
  return Meter(model).measure(state, inputs);
}

std::optional<double> ActuatorWork::add(const Model& model, const State& state, const Inputs& inputs) {
  assert(check_sizes(model, state));
  if (model.actuation.empty()) return std::nullopt;
  const std::vector<double> r = rest_lengths(model, state.step, 0.0, inputs.channels);
  std::vector<double> pulls(r.size(), 0.0);
  for (const Spring& spring : springs_of(model)) {
    const SpringClass& c = model.spring_classes[spring.spring_class];
    const double stretch =
        length(state.position[spring.a] - state.position[spring.b]) - r[spring.spring_class];
    if (!(c.cord && stretch < 0.0)) pulls[spring.spring_class] += c.stiffness * stretch;
  }
  ActuatorWork next;
  next.before_.reserve(model.actuation.classes.size());
  for (const ActuatedClass& of : model.actuation.classes)
    next.before_.push_back({r[of.spring_class], pulls[of.spring_class]});
  return append(next);
}

std::optional<double> ActuatorWork::append(const ActuatorWork& next) {
  const std::vector<Load>& now = next.before_;
  if (now.empty()) return std::nullopt;
  // A change of phases may have made other classes.
  for (std::size_t n = 0; before_.size() == now.size() && n < now.size(); ++n)
    sum_ -= 0.5 * (before_[n].pull + now[n].pull) * (now[n].length - before_[n].length);
  before_ = now;
  return sum_;
}

double largest_actuation_energy(const Model& model) {
  if (model.actuation.empty()) return 0.0;
  const std::vector<LengthRange> ranges = rest_length_ranges(model);
  const std::vector<std::uint64_t> springs = springs_by_class(model);
  double sum = 0.0;
  for (std::size_t c = 0; c < ranges.size(); ++c) {
    const SpringClass& of = model.spring_classes[c];
    // A cord that is longer than at rest hangs slack.
    const double shorter = of.rest_length - ranges[c].least,
                 longer = of.cord ? 0.0 : ranges[c].most - of.rest_length;
    const double most = std::max(shorter, longer);
    sum += 0.5 * static_cast<double>(springs[c]) * of.stiffness * most * most;
  }
  return sum;
}

std::optional<std::string_view> first_not_finite(const Measures& m) {
  const std::pair<double, std::string_view> figures[] = {{m.kinetic, "the kinetic energy"},
                                                         {m.elastic, "the elastic energy"},
                                                         {m.gravitational, "the gravitational energy"},
                                                         {m.total(), "the total energy"},
                                                         {m.momentum.x, "the momentum along x"},
                                                         {m.momentum.y, "the momentum along y"},
                                                         {m.momentum.z, "the momentum along z"},
                                                         {m.max_speed, "the largest speed"},
                                                         {m.min_height, "the lowest height"}};
  for (const auto& [value, name] : figures)
    if (!std::isfinite(value)) return name;
  return std::nullopt;
}

}  // namespace aspic
