#include "run/energy_watch.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <utility>

#include "model/springs.h"
#include "model/terrain.h"

namespace aspic {
namespace {

/// Of what is in motion and in springs, what may come from nowhere before it is reported: explicit Euler and
/// points that are found deep at once gain some.
constexpr double energy_share = 0.15;

/// What balls had that were launched in these steps.
Measures launched(const Model& model, std::uint64_t after, std::uint64_t until) {
  Model thrown;
  thrown.simulation = model.simulation;
  for (const Ball& ball : model.balls)
    if (ball.launched(until) && !ball.launched(after)) thrown.balls.push_back(ball);
  State start = initial_state(thrown, Precision::double_);
  start.step = until;
  return measure_motion(thrown, start);
}

double pull_energy(const State& state, const Inputs& inputs) {
  double sum = 0.0;
  for (const Pull& pull : inputs.pulls) {
    const Vec3 e = (pull.ball ? state.ball_position : state.position)[pull.particle] - pull.anchor;
    sum += 0.5 * pull.stiffness * dot(e, e);
  }
  return sum;
}

bool pulled(const InputLog& inputs, std::uint64_t from, std::uint64_t to) {
  for (std::optional<std::uint64_t> step = from; step && *step <= to; step = inputs.next_change(*step))
    if (!inputs.at(*step).pulls.empty()) return true;
  return false;
}

/// By how much anchors that move raise √E; nothing where a pull is new or stiffer, which may store any
/// energy.
std::optional<double> anchor_raise(const Inputs& before, const Inputs& after) {
  double raise = 0.0;
  for (std::size_t n = 0; n < after.pulls.size(); ++n) {
    if (n >= before.pulls.size()) return std::nullopt;
    const Pull &was = before.pulls[n], &is = after.pulls[n];
    if (was.particle != is.particle || was.ball != is.ball || was.stiffness < is.stiffness)
      return std::nullopt;
    raise += std::sqrt(0.5 * is.stiffness) * length(is.anchor - was.anchor);
  }
  return raise;
}

/// By how much rest lengths that change raise √E.
double actuator_raise(const Model& model, const InputLog& inputs, std::uint64_t from, std::uint64_t to) {
  const std::vector<std::uint64_t> springs = springs_by_class(model);
  RestLengths lengths(model);
  const auto at = [&](std::uint64_t step) { return lengths.at(step, 0.0, inputs.at(step).channels); };
  std::vector<double> before(model.actuation.classes.size());
  std::ranges::copy(at(from), before.begin());
  double raise = 0.0;
  for (std::uint64_t step = from + 1; step <= to; ++step) {
    const std::span<const double> after = at(step);
    double sum = 0.0;
    for (std::size_t n = 0; n < before.size(); ++n) {
      const std::uint32_t of = model.actuation.classes[n].spring_class;
      const double change = after[n] - before[n];
      sum += static_cast<double>(springs[of]) * model.spring_classes[of].stiffness * change * change;
    }
    raise += std::sqrt(0.5 * sum);
    std::ranges::copy(after, before.begin());
  }
  return raise;
}

}  // namespace

struct EnergyWatch::Work {
  bool known = true, any = false;
  double raise = 0.0;  // S [√J]
  double given = 0.0;  // on weights and dampers [J]
};

EnergyWatch::EnergyWatch(const Model& model, double interval)
    : model_(model),
      interval_(interval),
      driven_(!model.actuation.empty() ||
              std::ranges::any_of(model.terrain, [](const Terrain& t) { return t.motion.has_value(); })) {
  for (std::uint32_t i = 0; i < model.particle_count(); ++i) mass_ += model.mass[i];
  for (const Ball& ball : model.balls) mass_ += ball.mass;
  const std::vector<std::uint64_t> springs = springs_by_class(model);
  for (std::size_t c = 0; c < springs.size(); ++c) {
    all_.stiffness += static_cast<double>(springs[c]) * model.spring_classes[c].stiffness;
    all_.damping += static_cast<double>(springs[c]) * model.spring_classes[c].damping;
  }
  all_.mass = mass_;
}

EnergyWatch::Reach EnergyWatch::reach(const Terrain& terrain, const State& state) const {
  const TerrainMotion& motion = *terrain.motion;
  const Terrain there = terrain_at(terrain, model_.simulation.timestep, state.step);
  const double fastest = 2.0 * std::numbers::pi * motion.frequency * motion.amplitude;
  const double gained = length(model_.simulation.gravity) * interval_;
  const auto near = [&](const Vec3& x, const Vec3& v, double radius) {
    return signed_distance(there, x) <
           radius + model_.contact.distance + interval_ * (length(v) + fastest + gained);
  };
  // A ball passes energy from terrain on to particles in contact with it.
  for (std::size_t b = 0; b < model_.balls.size(); ++b)
    if (near(state.ball_position[b], state.ball_velocity[b], model_.balls[b].radius)) return all_;
  Reach sum;
  std::vector<bool> reached(model_.particle_count());
  for (std::uint32_t i = 0; i < model_.particle_count(); ++i) {
    reached[i] = near(state.position[i], state.velocity[i], 0.0);
    if (reached[i]) sum.mass += model_.mass[i];
  }
  if (sum.mass == 0.0) return sum;
  for (const Spring& spring : springs_of(model_)) {
    if (!reached[spring.a] && !reached[spring.b]) continue;
    sum.stiffness += model_.spring_classes[spring.spring_class].stiffness;
    sum.damping += model_.spring_classes[spring.spring_class].damping;
  }
  return sum;
}

EnergyWatch::Energy EnergyWatch::energy(const State& state, const InputLog& inputs) {
  if (!meter_) meter_.emplace(model_);
  const Inputs& now = inputs.at(state.step);
  const Measures m = meter_->measure(state, now);
  const double pulls = pull_energy(state, now);
  Energy energy = {state.step, m.total() + pulls, m.kinetic + m.elastic + pulls, {}};
  for (const Terrain& terrain : model_.terrain)
    energy.reach.push_back(terrain.motion ? reach(terrain, state) : Reach());
  return energy;
}

EnergyWatch::Work EnergyWatch::work(const Energy& from, const Energy& to, const InputLog& inputs) const {
  Work work;
  work.any = pulled(inputs, from.step, to.step);
  std::uint64_t step = from.step;
  for (auto next = inputs.next_change(step); next && *next <= to.step; next = inputs.next_change(step)) {
    const auto raise = anchor_raise(inputs.at(step), inputs.at(*next));
    work.known = work.known && raise;
    work.raise += raise.value_or(0.0);
    step = *next;
  }
  if (!model_.actuation.empty()) work.raise += actuator_raise(model_, inputs, from.step, to.step);
  const double h = model_.simulation.timestep;
  // Who looks seldom cannot know what came near in between.
  const bool seldom = static_cast<double>(to.step - from.step) * h > 1.5 * interval_;
  for (std::size_t n = 0; n < model_.terrain.size(); ++n) {
    if (!model_.terrain[n].motion) continue;
    const Reach &a = seldom ? all_ : from.reach[n], &b = to.reach[n];
    Pose before = pose_at(*model_.terrain[n].motion, h, from.step);
    double way = 0.0, squares = 0.0, speeds = length(before.velocity);
    for (step = from.step + 1; step <= to.step; ++step) {
      const Pose after = pose_at(*model_.terrain[n].motion, h, step);
      const double moved = length(after.offset - before.offset);
      way += moved;
      squares += moved * moved;
      speeds += length(after.velocity - before.velocity);
      before = after;
    }
    speeds += length(before.velocity);
    work.raise +=
        std::sqrt(0.5 * (a.stiffness + b.stiffness)) * way + std::sqrt(0.5 * (a.mass + b.mass)) * speeds;
    work.given += 0.25 * (a.damping + b.damping) * squares / h +
                  length(model_.simulation.gravity) * (a.mass + b.mass) * way;
  }
  work.any = work.any || work.raise > 0.0;
  return work;
}

void EnergyWatch::begin(const State& state, const InputLog& inputs) {
  last_ = energy(state, inputs);
  base_ = last_->total;
  base_step_ = state.step;
}

std::optional<EnergyRise> EnergyWatch::look(const State& state, const InputLog& inputs) {
  if (!last_ || state.step < last_->step) {
    begin(state, inputs);
    return std::nullopt;
  }
  const Measures balls = launched(model_, last_->step, state.step);
  base_ += balls.total();
  if (!driven_ && !pulled(inputs, last_->step, state.step)) {
    last_->step = state.step;
    // Energy that is only in springs shows as soon as it moves something.
    const bool more = measure_motion(model_, state).total() > base_;
    if (!more) meter_.reset();  // it takes much of the memory of a run
    if (!more) return std::nullopt;
  }
  const Energy from = *std::move(last_);
  last_ = energy(state, inputs);
  const Work done = work(from, *last_, inputs);
  const double fall = length(model_.simulation.gravity) * std::sqrt(0.5 * mass_) *
                      model_.simulation.timestep * static_cast<double>(state.step - from.step);
  const double root = std::sqrt(from.moving + balls.kinetic + done.given) + fall;
  const double most = base_ + done.given + done.raise * (2.0 * root + done.raise);
  const EnergyRise rise = {last_->total, last_->total - most, base_step_, done.any};
  if (done.any) {
    base_ = last_->total;
    base_step_ = state.step;
  }
  // Explicit Euler gains ½·M·g²·h² in a step of free fall: more than the share in the first steps alone.
  const double gained = length(model_.simulation.gravity) * model_.simulation.timestep;
  const auto steps = static_cast<double>(std::min<std::uint64_t>(state.step - rise.since, 10));
  const double allowed = energy_share * last_->moving + 0.5 * mass_ * gained * gained * steps;
  if (!done.known || !(rise.excess > allowed)) return std::nullopt;
  return rise;
}

}  // namespace aspic
