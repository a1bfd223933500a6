// Inputs act to the same bits on every backend: several pulls at a time, and pins that come and go.
#include <gtest/gtest.h>

#include <vector>

#include "cpu_parallel/cpu_solver.h"
#include "cpu_reference/reference_solver.h"
#include "gpu_solver/gpu_solver.h"
#include "support/busy_inputs.h"
#include "support/equality_cases.h"
#include "support/gl_fixture.h"
#include "support/model_building.h"
#include "support/value_of.h"

namespace aspic {
namespace {

class InputsOnTheDevice : public aspic::testing::GlTest {
 protected:
  static State run(Solver& solver, const InputLog& log, std::uint64_t steps) {
    const auto advanced = advance(solver, log, 0, steps);
    EXPECT_TRUE(advanced.ok()) << advanced.error().message();
    if (advanced.ok()) {
      EXPECT_FALSE(advanced->divergence.has_value());
    }
    return *solver.state();
  }
};

TEST_F(InputsOnTheDevice, EveryBackendHasTheReferencesBits) {
  // From the end: ConstantsOnTheDevice may run beside it, and either finds compiled what the other has
  // reached.
  const std::vector<test::EqualityCase>& cases = test::covering_cases();
  for (auto at = cases.rbegin(); at != cases.rend(); ++at) {
    const test::EqualityCase& row = *at;
    SCOPED_TRACE(test::text_of(row));
    const SharedModel model = shared(test::model_of(row));
    const bool newton = row_of(model->simulation.integrator).kind() == MethodKind::newton;
    const std::uint64_t each = newton ? 2 : 6;
    const InputLog log = test::busy_inputs(*model, each);
    auto reference = std::move(make_reference_solver(model, Precision::single)).value();
    const State expected = run(*reference, log, 5 * each);
    auto untouched = std::move(make_reference_solver(model, Precision::single)).value();
    ASSERT_NE(run(*untouched, {}, 5 * each), expected);
    auto cpu = std::move(make_cpu_solver(model, {.threads = 2})).value();
    EXPECT_EQ(run(*cpu, log, 5 * each), expected);
    GpuOptions options;
    options.split_stages = true;
    options.force_path = row.path;
    options.lattice_run = row.lattice_run;
    auto gpu = make_gpu_solver(context(), model, options);
    ASSERT_TRUE(gpu.ok()) << gpu.error().message();
    (*gpu)->set_late(!newton);
    EXPECT_EQ(run(**gpu, log, 5 * each), expected);
  }
}

// Pins begin with a step: the state before it is what it was, on every backend, and a load keeps them.
TEST_F(InputsOnTheDevice, PinsBeginWithTheNextStep) {
  ModelSettings settings = test::low_cube(4, Integrator::runge_kutta_4, ContactModel::coulomb);
  settings.cubes[0].pinned.names = {"left-top-back"};
  const SharedModel model = shared(test::build(settings));
  std::uint32_t held = 0;
  while (model->inverse_mass[held] != 0.0) ++held;
  auto reference = std::move(make_reference_solver(model, Precision::single)).value();
  auto cpu = std::move(make_cpu_solver(model)).value();
  auto gpu = test::value_of(make_gpu_solver(context(), model));
  std::vector<std::uint64_t> hashes;
  for (Solver* const solver : {reference.get(), cpu.get(), static_cast<Solver*>(gpu.get())}) {
    SCOPED_TRACE(solver->backend());
    ASSERT_TRUE(solver->advance(20).ok());
    const State before = *solver->state();
    ASSERT_NE(before.velocity[40], Vec3{});
    ASSERT_TRUE(solver->set_inputs({.pinned = {40, 7}}).ok());
    EXPECT_EQ(*solver->state(), before);
    ASSERT_TRUE(solver->set_inputs({}).ok());
    ASSERT_TRUE(solver->set_inputs({.pinned = {40}, .released = {held}}).ok());
    ASSERT_TRUE(solver->advance(30).ok());
    const State after = *solver->state();
    EXPECT_EQ(after.velocity[40], Vec3{});
    EXPECT_EQ(after.position[40], before.position[40]);
    EXPECT_NE(after.velocity[7], Vec3{});
    EXPECT_NE(after.position[held], before.position[held]);
    // A state in which the pinned particle moves: it stops with the next step.
    ASSERT_TRUE(solver->load(before).ok());
    EXPECT_EQ(*solver->state(), before);
    ASSERT_TRUE(solver->advance(30).ok());
    EXPECT_EQ(*solver->state(), after);
    ASSERT_NE(after.velocity[held], Vec3{});
    ASSERT_TRUE(solver->set_inputs({}).ok());
    ASSERT_TRUE(solver->advance(30).ok());
    const State last = *solver->state();
    EXPECT_NE(last.position[40], after.position[40]);
    EXPECT_EQ(last.position[held], after.position[held]) << "pinned by the scene again, it stands";
    EXPECT_EQ(last.velocity[held], Vec3{});
    // A state in which a particle moves that the scene pins, as a checkpoint at the end of a release has it.
    ASSERT_TRUE(solver->load(after).ok());
    ASSERT_TRUE(solver->advance(30).ok());
    EXPECT_EQ(*solver->state(), last);
    hashes.push_back(state_hash(last));
  }
  EXPECT_EQ(hashes[1], hashes[0]);
  EXPECT_EQ(hashes[2], hashes[0]);
}

TEST_F(InputsOnTheDevice, AsManyPullsAsThereMayBe) {
  for (const Integrator integrator : {Integrator::midpoint, Integrator::implicit_euler}) {
    const SharedModel model = shared(test::build(test::low_cube(5, integrator, ContactModel::course)));
    InputLog log;
    Inputs inputs;
    for (std::uint32_t n = 0; n < most_pulls; ++n)
      inputs.pulls.push_back({n * 7 % 125, {0.01 * n, 2.0 + 0.003 * n, -0.005 * n}, 10.0 + n, 0.5});
    log.set(0, inputs);
    auto reference = std::move(make_reference_solver(model, Precision::single)).value();
    auto gpu = test::value_of(make_gpu_solver(context(), model));
    EXPECT_EQ(run(*gpu, log, 12), run(*reference, log, 12));
  }
}

}  // namespace
}  // namespace aspic
