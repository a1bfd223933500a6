// What actuators put into springs, booked over states of a run.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "aspic/analysis.h"
#include "base/split_mix.h"
#include "model/actuation.h"
#include "model/springs.h"
#include "support/actuated.h"
#include "support/epsilon.h"
#include "support/model_building.h"
#include "support/reference_runs.h"

namespace aspic {
namespace {

/// Every spring: L, r [m], k(L − r) [N], dL/dt [m/s], k [N/m] and c [N·s/m].
struct SpringNow {
  double length, rest_length, force, rate, stiffness, damping;
};
std::vector<SpringNow> springs_now(const Model& model, const State& state, const Inputs& inputs = {}) {
  const std::vector<double> r = rest_lengths(model, state.step, 0.0, inputs.channels);
  std::vector<SpringNow> all;
  for (const Spring& spring : springs_of(model)) {
    const SpringClass& c = model.spring_classes[spring.spring_class];
    const Vec3 d = state.position[spring.a] - state.position[spring.b];
    const double l = length(d), of = r[spring.spring_class];
    const double force = c.cord && l < of ? 0.0 : c.stiffness * (l - of);
    const double rate = dot(d, state.velocity[spring.a] - state.velocity[spring.b]) / l;
    all.push_back({l, of, force, rate, c.stiffness, c.damping});
  }
  return all;
}

/// Two particles that are held at a distance of 5 m, and a spring of 8 N/m between them that wants 2 m
/// (1 + a·w).
Model held_spring(Signal signal) {
  Model model;
  model.simulation.timestep = 0.125;
  model.mass = {2.0, 4.0};
  model.inverse_mass = {0.0, 0.0};
  model.spring_classes = {{SpringType::structural, 8.0, 1.0, 2.0, false}};
  model.listed_springs = {{0, 1, 0}};
  Actuator actuator;
  actuator.amplitude = 0.5;
  actuator.signal = signal;
  actuator.frequency = 1.0;
  model.actuation.actuators = {actuator};
  model.actuation.drives = {{0, 0.0}};
  model.actuation.stretches = {{{0}}};
  model.actuation.shares = {{0, 1.0}};
  model.actuation.classes = {{0, {}, 0, 1}};
  return model;
}
State held_at(std::uint64_t step) {
  State state;
  state.step = step;
  state.position = {{0.0, 0.0, 0.0}, {5.0, 0.0, 0.0}};
  state.velocity = {{}, {}};
  return state;
}

// What a spring holds more is what was done, as long as its ends hold still: over a jump, too, and in any
// number of pieces.
TEST(ActuatorWork, OfAHeldSpringIsItsEnergy) {
  for (const Signal signal : {Signal::triangle, Signal::square, Signal::sine}) {
    const Model model = held_spring(signal);
    for (const std::uint64_t every : {1u, 2u, 5u}) {
      ActuatorWork work;
      const double start = measure(model, held_at(0)).elastic;
      for (std::uint64_t step = 0; step <= 30; step += every) {
        const State state = held_at(step);
        EXPECT_NEAR(*work.add(model, state), measure(model, state).elastic - start, 40 * test::eps * start);
      }
    }
  }
  ActuatorWork work;
  const Model model = held_spring(Signal::triangle);
  EXPECT_EQ(work.add(model, held_at(0)), 0.0);
  // r goes from 2 m to 3 m: ½·8·(2² − 3²).
  EXPECT_EQ(work.add(model, held_at(2)), -20.0);
}

TEST(ActuatorWork, OfInputsCountsWhereTheyChange) {
  const Model model = held_spring(Signal::input);
  ActuatorWork work;
  Inputs inputs;
  EXPECT_EQ(work.add(model, held_at(0), inputs), 0.0);
  inputs.channels = {1.0};
  EXPECT_EQ(work.add(model, held_at(1), inputs), -20.0);
  EXPECT_EQ(work.add(model, held_at(2), inputs), -20.0);
}

TEST(ActuatorWork, ThereIsNoneWithoutActuators) {
  const Model model = test::build(test::cube_on_plane(3));
  EXPECT_EQ(ActuatorWork().add(model, initial_state(model, Precision::single)), std::nullopt);
}

// Between any two states the elastic energy changes by the work of actuators, and that of particles,
// Σ½(f₀ + f₁)(L₁ − L₀): an identity, of which only rounding is left. The cords are kept from going slack.
TEST(ActuatorWork, AndThatOfParticlesAreTheChangeOfElasticEnergy) {
  ModelSettings settings = test::actuated(Integrator::symplectic_euler, ContactModel::coulomb);
  settings.contact.bodies = false;
  settings.goal_nets.clear();
  std::erase_if(settings.actuators[1].bodies, [](const std::string& body) { return body == "goal-net[0]"; });
  const Model model = test::build(settings);
  State from = initial_state(model, Precision::double_), to = from;
  SplitMix64 random(3);
  for (Vec3& x : to.position)
    for (double* const c : {&x.x, &x.y, &x.z}) *c += 0.1 * (2.0 * random.share() - 1.0);
  from.step = 40;
  to.step = 777;
  Inputs before, after;
  before.channels = {0.4};
  after.channels = {-0.7};
  ActuatorWork work;
  work.add(model, from, before);
  const double done = *work.add(model, to, after);
  const std::vector<SpringNow> first = springs_now(model, from, before),
                               second = springs_now(model, to, after);
  double particles = 0.0, size = 0.0;
  for (std::size_t n = 0; n < first.size(); ++n) {
    particles += 0.5 * (first[n].force + second[n].force) * (second[n].length - first[n].length);
    // Lengths are rounded, and the products of their differences are at most these.
    const double most = first[n].length + second[n].length + first[n].rest_length + second[n].rest_length;
    size += first[n].stiffness * most * most;
  }
  const double change = measure(model, to, after).elastic - measure(model, from, before).elastic;
  EXPECT_GT(std::abs(done), 0.01 * std::abs(change));
  // Sums of so many numbers.
  EXPECT_NEAR(done + particles, change, static_cast<double>(first.size()) * test::eps * size);
}

/// A beam of muscle in free space, which is at rest, is moved by a signal of straight lines for half a
/// second, and comes to rest again.
ModelSettings beam() {
  ModelSettings settings;
  settings.simulation.integrator = Integrator::runge_kutta_4;
  settings.simulation.timestep = 1.0 / 4096.0;
  settings.simulation.gravity = {};
  settings.materials = {{1000.0, 10000.0, 0.5, "fat"}, {1000.0, 10000.0, 0.5, "muscle"}};
  VoxelsSettings& voxels = settings.voxels.emplace_back();
  voxels.size = 0.1;
  voxels.layers = {{"111"}, {"222"}};
  voxels.palette = {{"1", "fat"}, {"2", "muscle"}};
  ActuatorSettings& actuator = settings.actuators.emplace_back();
  actuator.select.materials = {"muscle"};
  actuator.amplitude = 0.2;
  actuator.signal = Signal::table;
  actuator.table = {{0.0, 0.0}, {0.25, 1.0}, {0.5, 0.0}, {100.0, 0.0}};
  actuator.frequency = 1.0;
  return settings;
}

using Samples = std::vector<std::vector<SpringNow>>;

/// The most that second differences of f(sample) come to between two samples: where these are neighbors,
/// those at both are near that.
template <class F>
double largest_bend(const Samples& samples, std::size_t from, std::size_t to, const F& f) {
  const std::size_t first = to - from > 1 ? from + 1 : std::max<std::size_t>(from, 1);
  const std::size_t last = to - from > 1 ? to - 1 : std::min(to, samples.size() - 2);
  double most = 0.0;
  for (std::size_t n = first; n <= last; ++n)
    most = std::max(most, std::abs(f(n - 1) - 2.0 * f(n) + f(n + 1)));
  return most;
}

/// What work that is booked every `every` steps may miss, of samples of all steps: the trapezoidal rule
/// misses T³/12·|f''| of an integral over T; rest lengths are straight meanwhile, so it is that of the force.
double error_of_work(const Samples& samples, std::size_t every) {
  const auto steps = static_cast<double>(every);
  double sum = 0.0;
  for (std::size_t at = 0; at + every < samples.size(); at += every)
    for (std::size_t s = 0; s < samples.front().size(); ++s) {
      const double moved = samples[at + every][s].rest_length - samples[at][s].rest_length;
      if (moved == 0.0) continue;
      const auto force = [&](std::size_t n) { return samples[n][s].force; };
      sum += std::abs(moved) * steps * steps * largest_bend(samples, at, at + every, force) / 12.0;
    }
  return sum;
}

/// Σ∫c(dL/dt)² dt by the same rule, from samples that are `h` apart, and what it may miss.
struct Dissipated {
  double energy = 0.0, error = 0.0;
};
Dissipated dissipated_in(const Samples& samples, double h) {
  const auto power = [&](std::size_t n) {
    double sum = 0.0;
    for (const SpringNow& spring : samples[n]) sum += spring.damping * spring.rate * spring.rate;
    return sum;
  };
  Dissipated sum;
  for (std::size_t n = 0; n + 1 < samples.size(); ++n) {
    sum.energy += 0.5 * h * (power(n) + power(n + 1));
    sum.error += h * largest_bend(samples, n, n + 1, power) / 12.0;
  }
  return sum;
}

// What actuators did is what dampers took and springs hold, however often it is booked.
TEST(ActuatorWork, IsDissipatedAndStored) {
  const Model model = test::build(beam());
  const auto solver = test::solver_for(model, Precision::double_);
  constexpr std::uint64_t steps = 8192;
  constexpr std::uint64_t intervals[] = {1, 4, 16};
  ActuatorWork works[3];
  double booked[3] = {};
  Samples samples;
  State state;
  for (std::uint64_t step = 0; step <= steps; ++step) {
    state = test::advanced(*solver, step > 0 ? 1 : 0);
    samples.push_back(springs_now(model, state));
    for (std::size_t i = 0; i < 3; ++i)
      if (step % intervals[i] == 0) booked[i] = *works[i].add(model, state);
  }
  const double left = measure(model, state).total();
  const Dissipated dissipated = dissipated_in(samples, model.simulation.timestep);
  EXPECT_LT(left, 1e-6 * booked[0]) << "it is not at rest yet";
  for (std::size_t i = 0; i < 3; ++i) {
    const double bound = error_of_work(samples, intervals[i]) + dissipated.error;
    EXPECT_LT(bound, 0.01 * booked[i]);
    EXPECT_NEAR(booked[i], dissipated.energy + left, bound) << "every " << intervals[i] << " steps";
  }
}

}  // namespace
}  // namespace aspic
