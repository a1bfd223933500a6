// Actuated bodies on the device: the reference's bits on every path, however steps are queued.
#include <gtest/gtest.h>

#include "cpu_reference/reference_solver.h"
#include "gpu_solver/gpu_solver.h"
#include "support/actuated.h"
#include "support/gl_fixture.h"
#include "support/integrator_names.h"
#include "support/model_building.h"
#include "support/value_of.h"

namespace aspic {
namespace {

class ActuatedOnTheDevice : public aspic::testing::GlTest {
 protected:
  std::unique_ptr<GpuSolver> solver(const Model& model, ForcePath path = ForcePath::automatic) {
    GpuOptions options;
    options.split_stages = true;
    options.force_path = path;
    return test::value_of(make_gpu_solver(context(), model, options));
  }
  static std::unique_ptr<Solver> reference(const Model& model) {
    return std::move(*make_reference_solver(model, Precision::single));
  }
};

/// One method of one stage, of several, and one that is solved, on all paths; the others on one.
TEST_F(ActuatedOnTheDevice, HasTheReferencesBits) {
  for (const Integrator integrator : all_integrators) {
    const bool every = integrator == Integrator::symplectic_euler ||
                       integrator == Integrator::runge_kutta_4 || integrator == Integrator::implicit_euler;
    const ContactModel contact =
        integrator == Integrator::midpoint || integrator == Integrator::implicit_euler
            ? ContactModel::course
            : ContactModel::coulomb;
    ModelSettings settings = test::actuated(integrator, contact);
    test::resist(settings, 0.4);
    const Model model = test::build(settings);
    const std::uint64_t steps = row_of(integrator).traits.long_steps ? 12 : 120;
    const Inputs inputs = {.channels = {0.4}};
    const auto expected = reference(model);
    ASSERT_TRUE(expected->set_inputs(inputs).ok());
    ASSERT_FALSE((*expected->advance(steps)).divergence.has_value());
    for (const ForcePathRow& path : force_paths()) {
      if (!works_with(path.path, integrator) || (!every && path.path != ForcePath::lattice)) continue;
      const auto gpu = solver(model, path.path);
      ASSERT_TRUE(gpu->set_inputs(inputs).ok());
      ASSERT_FALSE((*gpu->advance(steps)).divergence.has_value());
      EXPECT_EQ(*gpu->state(), *expected->state()) << name_of(integrator) << ", " << path.name;
    }
  }
}

// Classes of cells in 16 bits.
TEST_F(ActuatedOnTheDevice, CellsOfManyClassesHaveTheReferencesBits) {
  const Model model = test::build(test::cells_of_many_classes(Integrator::symplectic_euler));
  GpuOptions options;
  options.split_stages = true;
  options.lattice_run = 1;
  const auto gpu = make_gpu_solver(context(), model, options);
  ASSERT_TRUE(gpu.ok()) << gpu.error().message();
  EXPECT_EQ((*gpu)->force_path(), ForcePath::lattice);
  const auto expected = reference(model);
  for (Solver* const each : {static_cast<Solver*>(gpu->get()), expected.get()})
    ASSERT_FALSE((*each->advance(60)).divergence.has_value());
  EXPECT_EQ(*(*gpu)->state(), *expected->state());
}

// Channels and constants that change between queued steps; a state that is loaded.
TEST_F(ActuatedOnTheDevice, FollowsInputsConstantsAndLoads) {
  for (const Integrator integrator : {Integrator::midpoint, Integrator::implicit_euler}) {
    ModelSettings settings = test::actuated(integrator, ContactModel::coulomb);
    const Model model = test::build(settings);
    settings.actuators[0].amplitude = 0.05;
    settings.actuators[0].signal = Signal::square;
    settings.actuators[3].frequency = 9.0;
    const Model other = test::build(settings);
    const auto gpu = solver(model);
    const auto expected = reference(model);
    const std::uint64_t steps = row_of(integrator).traits.long_steps ? 3 : 20;
    for (Solver* const each : {static_cast<Solver*>(gpu.get()), expected.get()}) {
      for (int n = 0; n < 5; ++n) {
        ASSERT_TRUE(each->set_inputs({.channels = {0.2 * n}}).ok());
        ASSERT_FALSE((*each->advance(steps)).divergence.has_value());
      }
      ASSERT_TRUE(each->set_constants(shared(other)).ok());
      ASSERT_FALSE((*each->advance(steps)).divergence.has_value());
      State state = *each->state();
      state.step = 7;
      ASSERT_TRUE(each->load(state).ok());
      ASSERT_FALSE((*each->advance(steps)).divergence.has_value());
    }
    EXPECT_EQ(*gpu->state(), *expected->state()) << name_of(integrator);
  }
}

// More classes than the uniform block holds: a phase for each cell.
TEST_F(ActuatedOnTheDevice, HoldsAsManyClassesAsPhasesMake) {
  ModelSettings settings = test::cube_on_plane(6, 2.01);
  ActuatorSettings& actuator = settings.actuators.emplace_back();
  actuator.amplitude = 0.2;
  actuator.frequency = 4.0;
  actuator.phase.cells = "5 5 5:";
  for (int n = 0; n < 125; ++n) actuator.phase.cells += " " + std::to_string(0.0073 * n);
  const Model model = test::build(settings);
  ASSERT_GT(model.spring_classes.size(), 640u);
  const auto expected = reference(model);
  ASSERT_FALSE((*expected->advance(100)).divergence.has_value());
  for (const ForcePath path : {ForcePath::gather, ForcePath::per_spring}) {
    const auto gpu = solver(model, path);
    ASSERT_FALSE((*gpu->advance(100)).divergence.has_value());
    EXPECT_EQ(*gpu->state(), *expected->state());
  }
}

}  // namespace
}  // namespace aspic
