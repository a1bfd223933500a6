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
#include "physics/body_force.h"
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
  const physics::BodyForce<double> force(model);
  if (std::ranges::any_of(resistance_constants,
                          [&](const auto& row) { return model.simulation.*row.value > 0.0; }))
    m.drag_power = 0.0;
  double fastest_squared = 0.0, lowest = std::numeric_limits<double>::infinity();
  const auto add = [&](double mass, const Vec3& x, const Vec3& v, double rotation) {
    m.gravitational -= mass * dot(model.simulation.gravity, x);
    m.kinetic += 0.5 * mass * dot(v, v) + rotation;
    m.momentum = m.momentum + mass * v;
    if (m.drag_power)
      *m.drag_power += dot(physics::vec3_of(force.resistance(mass, physics::rounded<double>(v))), v);
    lowest = std::min(lowest, x.y);
    fastest_squared = std::max(fastest_squared, dot(v, v));
  };
  for (std::size_t i = 0; i < model.mass.size(); ++i)
    add(model.mass[i], state.position[i], state.velocity[i], 0.0);
  for (std::size_t b = 0; b < model.balls.size(); ++b) {
    const Ball& ball = model.balls[b];
    const Vec3& omega = state.ball_angular_velocity[b];
    if (ball.launched(state.step))
      add(ball.mass, state.ball_position[b], state.ball_velocity[b],
          0.5 * ball.inertia() * dot(omega, omega));
  }
  m.max_speed = std::sqrt(fastest_squared);
  if (std::isfinite(lowest)) m.min_height = lowest;
  return m;
}

Measures Meter::measure(const State& state, const Inputs& inputs) {
  const Model& model = parts_->model;
  Measures m = measure_motion(model, state);
  const auto classes = physics::classes_at<double>(model, state.step, 0.0, inputs.channels);
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
  const auto classes = physics::classes_at<double>(model, state.step, 0.0, inputs.channels);
  std::vector<double> pulls(classes.size(), 0.0);
  for (const auto& [a, b, of] : springs_of(model))
    pulls[of] += classes[of].k * physics::stretch(classes[of], length(state.position[a] - state.position[b]));
  ActuatorWork next;
  next.before_.reserve(model.actuation.classes.size());
  for (const ActuatedClass& of : model.actuation.classes)
    next.before_.push_back({classes[of.spring_class].r, pulls[of.spring_class]});
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
    const auto energy = [&](double r) {
      physics::SpringConstants<double> spring(model.spring_classes[c]);
      spring.r = r;
      return physics::spring_energy(spring, model.spring_classes[c].rest_length);
    };
    sum += static_cast<double>(springs[c]) * std::max(energy(ranges[c].least), energy(ranges[c].most));
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
