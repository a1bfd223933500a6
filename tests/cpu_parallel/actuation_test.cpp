// Actuated bodies: every backend on the processor has the reference's bits; methods keep their order; a body
// that nothing holds takes the size that its rest lengths have.
#include "model/actuation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "cpu_parallel/cpu_solver.h"
#include "cpu_parallel/stack.h"
#include "cpu_reference/reference_solver.h"
#include "model/integrator.h"
#include "model/springs.h"
#include "support/actuated.h"
#include "support/integrator_names.h"
#include "support/model_building.h"

namespace aspic {
namespace {

std::unique_ptr<Solver> reference(const Model& model, Precision precision = Precision::single) {
  return std::move(*make_reference_solver(model, precision));
}

class EveryMethodWithActuators : public testing::TestWithParam<Integrator> {};
INSTANTIATE_TEST_SUITE_P(Actuated, EveryMethodWithActuators, testing::ValuesIn(all_integrators),
                         test::by_integrator);

TEST_P(EveryMethodWithActuators, HasTheReferencesBitsOnAnyNumberOfThreads) {
  for (const ContactModel contact : {ContactModel::coulomb, ContactModel::course}) {
    ModelSettings settings = test::actuated(GetParam(), contact);
    test::resist(settings, 0.4);
    const Model model = test::build(settings);
    const Inputs inputs = {.channels = {0.4}};
    const std::uint64_t steps = test::actuated_steps(GetParam());
    const auto expected = reference(model);
    ASSERT_TRUE(expected->set_inputs(inputs).ok());
    ASSERT_FALSE((*expected->advance(steps)).divergence.has_value());
    for (const unsigned threads : {1u, 3u}) {
      const auto cpu = std::move(*make_cpu_solver(model, {.threads = threads}));
      ASSERT_TRUE(cpu->set_inputs(inputs).ok());
      ASSERT_FALSE((*cpu->advance(steps)).divergence.has_value());
      EXPECT_EQ(*cpu->state(), *expected->state()) << threads << " threads, " << name_of(contact);
    }
  }
}

TEST_P(EveryMethodWithActuators, AmplitudeZeroIsNoActuator) {
  ModelSettings settings = test::low_cube(4, GetParam(), ContactModel::coulomb);
  if (GetParam() == Integrator::implicit_euler) settings.simulation.timestep = 0.01;
  const std::uint64_t steps = test::actuated_steps(GetParam());
  const auto passive = reference(test::build(settings));
  ASSERT_FALSE((*passive->advance(steps)).divergence.has_value());
  ActuatorSettings& actuator = settings.actuators.emplace_back();
  actuator.amplitude = 0.0;
  actuator.phase.along = BodyAxis::x;
  const Model model = test::build(settings);
  const auto acted = reference(model), cpu = std::move(*make_cpu_solver(model, {}));
  for (Solver* const solver : {acted.get(), cpu.get()}) {
    ASSERT_FALSE((*solver->advance(steps)).divergence.has_value());
    EXPECT_EQ(*solver->state(), *passive->state());
  }
}

// A run is a function of step numbers and inputs.
TEST_P(EveryMethodWithActuators, GoesOnWhereItWas) {
  const Model model = test::build(test::actuated(GetParam(), ContactModel::coulomb));
  const std::uint64_t steps = test::actuated_steps(GetParam());
  const auto whole = reference(model), first = reference(model);
  ASSERT_FALSE((*whole->advance(steps)).divergence.has_value());
  ASSERT_FALSE((*first->advance(steps / 3)).divergence.has_value());
  const auto second = std::move(*make_cpu_solver(model, {}));
  ASSERT_TRUE(second->load(*first->state()).ok());
  ASSERT_FALSE((*second->advance(steps - steps / 3)).divergence.has_value());
  EXPECT_EQ(*second->state(), *whole->state());
}

TEST_P(EveryMethodWithActuators, TakesOtherConstants) {
  ModelSettings settings = test::actuated(GetParam(), ContactModel::coulomb);
  const Model before = test::build(settings);
  settings.actuators[0].amplitude = 0.05;
  settings.actuators[0].frequency = 7.0;
  settings.actuators[1].signal = Signal::square;
  const Model after = test::build(settings);
  const std::uint64_t steps = test::actuated_steps(GetParam()) / 2;
  for (const bool parallel : {false, true}) {
    const auto solver = parallel ? std::move(*make_cpu_solver(before, {})) : reference(before);
    ASSERT_FALSE((*solver->advance(steps)).divergence.has_value());
    const State middle = *solver->state();
    ASSERT_TRUE(solver->set_constants(shared(after)).ok());
    ASSERT_FALSE((*solver->advance(steps)).divergence.has_value());
    const auto fresh = reference(after);
    ASSERT_TRUE(fresh->load(middle).ok());
    ASSERT_FALSE((*fresh->advance(steps)).divergence.has_value());
    EXPECT_EQ(*solver->state(), *fresh->state()) << parallel;
  }
}

// By halving h on a smooth free spring system that is driven, against a fine Runge–Kutta solution.
TEST_P(EveryMethodWithActuators, ConvergesWithItsOrder) {
  ModelSettings settings;
  settings.simulation.integrator = GetParam();
  settings.simulation.gravity = {};
  settings.simulation.implicit.tolerance = 1e-13;
  settings.simulation.implicit.newton_iterations = 100;
  CubeSettings& cube = settings.cubes.emplace_back();
  cube.particles_per_edge = 2;
  cube.edge_length = 1.0;
  cube.structural = cube.shear = {20.0, 0.2};
  ActuatorSettings& actuator = settings.actuators.emplace_back();
  actuator.amplitude = 0.2;
  actuator.frequency = 1.5;
  actuator.phase.offset = 0.15;
  actuator.phase.along = BodyAxis::y;
  actuator.phase.wavelength = 3.0;
  actuator.axis = BodyAxis::x;
  const auto solve = [&](Integrator method, double h) {
    settings.simulation.integrator = method;
    settings.simulation.timestep = h;
    const auto solver = reference(test::build(settings), Precision::double_);
    EXPECT_FALSE((*solver->advance(static_cast<std::uint64_t>(std::lround(0.4 / h)))).divergence.has_value());
    return *solver->state();
  };
  const State exact = solve(Integrator::runge_kutta_4, 0.4 / 8192);
  double order = 0.0, coarse = 0.0;
  for (int halvings = 0; halvings < 8; ++halvings) {
    const State s = solve(GetParam(), std::ldexp(0.4 / 64, -halvings));
    double error = 0.0;
    for (std::size_t i = 0; i < s.position.size(); ++i)
      error = std::max(
          {error, length(s.position[i] - exact.position[i]), length(s.velocity[i] - exact.velocity[i])});
    if (error <= 2e-12) break;
    if (coarse > 0.0) order = std::log2(coarse / error);
    coarse = error;
  }
  EXPECT_NEAR(order, row_of(GetParam()).order, 0.06);
}

TEST(Actuated, EveryLaneOfAStackHasTheReferencesBits) {
  for (const Integrator integrator : {Integrator::symplectic_euler, Integrator::runge_kutta_4}) {
    std::vector<SharedModel> models;
    for (int n = 0; n < 5; ++n) {
      ModelSettings settings = test::actuated(integrator, ContactModel::coulomb);
      settings.contact.bodies = false;
      settings.actuators[0].amplitude = 0.03 * n;
      settings.actuators[0].phase.offset = 0.1 * n;
      models.push_back(shared(test::build(settings)));
    }
    ASSERT_TRUE(parallel::Stack::takes(*models[0]));
    ASSERT_TRUE(parallel::Stack::same(*models[0], *models[4]));
    parallel::Stack stack(models, std::make_shared<const parallel::UpperEnds>(*models[0]));
    std::vector<std::unique_ptr<Solver>> expected;
    for (std::size_t lane = 0; lane < models.size(); ++lane) {
      expected.push_back(std::move(*make_reference_solver(models[lane], Precision::single)));
      ASSERT_TRUE(expected[lane]->set_inputs({.channels = {0.1 * static_cast<double>(lane)}}).ok());
      stack.set_inputs(lane, expected[lane]->inputs());
    }
    for (int n = 0; n < 200; ++n) stack.advance();
    for (std::size_t lane = 0; lane < models.size(); ++lane) {
      ASSERT_FALSE((*expected[lane]->advance(200)).divergence.has_value());
      State state;
      resize(state, models[lane]->particle_count(), 0);
      const ConstStateView from = stack.view(lane);
      const StateView to = view_of(state);
      for (std::size_t field = 0; field < 2; ++field) copy_vectors(from[field], to[field]);
      state.step = stack.step(lane);
      EXPECT_EQ(state, *expected[lane]->state()) << lane;
    }
  }
}

// Nothing holds it: at rest it has just the size that cells want, whatever they are made of.
TEST(Actuated, AFreeBodyTakesTheSizeItsCellsWant) {
  for (const BodyAxis axis : {BodyAxis::none, BodyAxis::x, BodyAxis::y}) {
    ModelSettings settings;
    settings.simulation.gravity = {};
    settings.simulation.integrator = Integrator::implicit_euler;
    settings.simulation.timestep = 0.02;
    settings.materials = {{1000.0, 1e5, 0.5, "muscle"}, {500.0, 3e4, 0.5, "fat"}};
    VoxelsSettings& voxels = settings.voxels.emplace_back();
    voxels.size = 0.1;
    voxels.layers = {{"112", "1.2"}, {"122", "111"}};
    voxels.palette = {{"1", "muscle"}, {"2", "fat"}};
    ActuatorSettings& actuator = settings.actuators.emplace_back();
    actuator.volume_change = 0.5;
    actuator.axis = axis;
    actuator.signal = Signal::table;
    actuator.table = {{0.0, 1.0}, {1.0, 1.0}};
    actuator.ramp = 0.2;
    const auto solver = reference(test::build(settings), Precision::double_);
    ASSERT_FALSE((*solver->advance(400)).divergence.has_value());
    // It may have turned meanwhile; its springs know nothing of that.
    const State after = *solver->state();
    const std::vector<double> r = rest_lengths(solver->model(), after.step, 0.0, {});
    double stretched = 0.0;
    for (const Spring& s : all_springs(solver->model())) {
      const double L = length(after.position[s.a] - after.position[s.b]);
      EXPECT_NEAR(L / r[s.spring_class], 1.0, 1e-6);
      stretched = std::max(stretched, L / solver->model().spring_classes[s.spring_class].rest_length);
    }
    EXPECT_NEAR(stretched, axis == BodyAxis::none ? std::cbrt(1.5) : 1.5, 1e-5);
  }
}

}  // namespace
}  // namespace aspic
