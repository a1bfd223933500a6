// Constants that change in mid-run: the bits are those of a new solver with the same state, on every backend.
#include <gtest/gtest.h>

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

/// The model with other constants throughout; `masses`: of particles and balls too.
SharedModel with_other_constants(Model model, bool masses) {
  for (SpringClass& spring : model.spring_classes) {
    spring.stiffness *= 0.8;
    spring.damping *= 1.1;
    spring.rest_length *= 1.01;
  }
  model.simulation.gravity = {0.3, -7.5, 0.1};
  model.simulation.timestep *= 0.9;
  model.simulation.implicit.tolerance = 3e-4;
  model.simulation.implicit.cg_iterations = 90;
  model.contact.distance *= 1.3;
  model.contact.resting_speed *= 1.2;
  model.contact.ball_restitution = 0.6;
  model.contact.ball_friction = 0.1;
  for (Terrain& terrain : model.terrain) {
    terrain.friction = 0.15;
    terrain.restitution = 0.4;
    terrain.mass = 40.0;
    if (terrain.motion) terrain.motion->amplitude *= 1.2;
  }
  if (!masses) return shared(std::move(model));
  for (Runs<double>* const runs : {&model.mass, &model.inverse_mass}) {
    const double factor = runs == &model.mass ? 1.25 : 0.8;
    Runs<double> changed;
    std::size_t first = 0;
    for (const auto& [end, value] : runs->runs()) {
      changed.push_back(value * factor, end - first);
      first = end;
    }
    *runs = changed;
  }
  for (Ball& ball : model.balls) {
    ball.mass *= 1.5;
    ball.radius *= 0.9;
  }
  return shared(std::move(model));
}

class ConstantsOnTheDevice : public aspic::testing::GlTest {
 protected:
  static std::unique_ptr<Solver> gpu_solver(const SharedModel& model, ForcePath path, std::uint32_t run = 0) {
    GpuOptions options;
    options.split_stages = true;
    options.force_path = path;
    options.lattice_run = run;
    auto made = test::value_of(make_gpu_solver(context(), model, options));
    made->set_late(true);
    return made;
  }
};

TEST_F(ConstantsOnTheDevice, AreThoseOfANewSolver) {
  std::size_t number = 0;
  for (const test::EqualityCase& row : test::covering_cases()) {
    SCOPED_TRACE(test::text_of(row));
    const SharedModel before = shared(test::model_of(row));
    const SharedModel after = with_other_constants(*before, number++ % 2 == 0);
    const bool newton = row_of(before->simulation.integrator).kind() == MethodKind::newton;
    const std::uint64_t steps = newton ? 2 : 8;
    const Inputs hands = test::busy_inputs(*before, 1).at(2);
    using Make = std::function<std::unique_ptr<Solver>(const SharedModel&)>;
    const Make makers[] = {
        [](const SharedModel& model) {
          return std::move(make_reference_solver(model, Precision::single)).value();
        },
        [](const SharedModel& model) { return std::move(make_cpu_solver(model, {.threads = 2})).value(); },
        [&](const SharedModel& model) { return gpu_solver(model, row.path, row.lattice_run); }};
    std::vector<std::uint64_t> hashes;
    for (const Make& make : makers) {
      const auto solver = make(before);
      SCOPED_TRACE(solver->backend());
      ASSERT_TRUE(solver->set_inputs(hands).ok());
      ASSERT_FALSE((*solver->advance(steps)).divergence.has_value());
      const State between = *solver->state();
      ASSERT_TRUE(solver->set_constants(after).ok());
      EXPECT_EQ(&solver->model(), after.get());
      // Another time step renumbers the state, so that its time stays.
      State renumbered = between;
      renumbered.step =
          step_at_same_time(between.step, before->simulation.timestep, after->simulation.timestep);
      EXPECT_EQ(*solver->state(), renumbered);
      const auto fresh = make(after);
      ASSERT_TRUE(fresh->load(renumbered).ok() && fresh->set_inputs(hands).ok());
      ASSERT_FALSE((*solver->advance(steps)).divergence.has_value());
      ASSERT_FALSE((*fresh->advance(steps)).divergence.has_value());
      EXPECT_EQ(*solver->state(), *fresh->state());
      hashes.push_back(state_hash(*solver->state()));
    }
    EXPECT_EQ(hashes[1], hashes[0]);
    EXPECT_EQ(hashes[2], hashes[0]);
  }
}

TEST_F(ConstantsOnTheDevice, EndADivergence) {
  for (const Integrator integrator : {Integrator::explicit_euler, Integrator::implicit_euler}) {
    const SharedModel model = shared(test::build(test::low_cube(4, integrator, ContactModel::coulomb)));
    std::vector<std::unique_ptr<Solver>> solvers;
    solvers.push_back(std::move(make_reference_solver(model, Precision::single)).value());
    solvers.push_back(std::move(make_cpu_solver(model)).value());
    solvers.push_back(gpu_solver(model, ForcePath::gather));
    std::vector<std::uint64_t> hashes;
    for (const auto& solver : solvers) {
      SCOPED_TRACE(solver->backend());
      ASSERT_TRUE(solver->set_inputs({{Pull{42, {1e6, 0.0, 0.0}, 500.0, 0.0}}}).ok());
      ASSERT_TRUE(solver->advance(50).ok());
      (void)solver->state();
      ASSERT_TRUE((*solver->advance(1)).divergence.has_value());
      ASSERT_TRUE(solver->set_inputs({}).ok());
      ASSERT_TRUE(solver->set_constants(with_other_constants(*model, false)).ok());
      const std::uint64_t step = solver->state()->step;
      ASSERT_FALSE((*solver->advance(10)).divergence.has_value());
      EXPECT_EQ(solver->state()->step, step + 10);
      hashes.push_back(state_hash(*solver->state()));
    }
    EXPECT_EQ(hashes[1], hashes[0]);
    EXPECT_EQ(hashes[2], hashes[0]);
  }
}

TEST_F(ConstantsOnTheDevice, AnotherTopologyIsRefused) {
  ModelSettings settings = test::low_cube(4, Integrator::explicit_euler, ContactModel::coulomb);
  settings.cloths.resize(1);
  settings.balls.resize(1);
  const SharedModel model = shared(test::build(settings));
  std::vector<std::pair<std::string, ModelSettings>> others(6, {"", settings});
  others[0].first = "bodies";
  others[0].second.cubes[0].particles_per_edge = 5;
  others[1].first = "number of balls";
  others[1].second.balls.resize(2);
  others[2].first = "kinds of terrain";
  others[2].second.terrain[0].shape = TerrainShape::sphere;
  others[3].first = "contact model";
  others[3].second.contact.model = ContactModel::course;
  others[4].first = "integrator";
  others[4].second.simulation.integrator = Integrator::midpoint;
  others[5].first = "kinds of terrain";
  others[5].second.terrain[0].motion.emplace();
  std::vector<std::unique_ptr<Solver>> solvers;
  solvers.push_back(std::move(make_reference_solver(model, Precision::double_)).value());
  solvers.push_back(std::move(make_cpu_solver(model)).value());
  solvers.push_back(gpu_solver(model, ForcePath::gather));
  for (const auto& solver : solvers) {
    for (const auto& [what, other] : others) {
      const Status taken = solver->set_constants(shared(test::build(other)));
      ASSERT_FALSE(taken.ok()) << what;
      EXPECT_EQ(taken.error().code, ErrorCode::usage);
      EXPECT_NE(taken.error().message().find(what), std::string::npos) << taken.error().message();
    }
    Model fewer = *model;
    fewer.listed_springs.pop_back();
    EXPECT_FALSE(solver->set_constants(shared(std::move(fewer))).ok());
    // Inputs that the other model refuses: a released particle that it does not pin.
    Model pinned = *model;
    pinned.inverse_mass.set(3, 0.0);
    ASSERT_TRUE(solver->set_constants(shared(std::move(pinned))).ok());
    ASSERT_TRUE(solver->set_inputs({.released = {3}}).ok());
    EXPECT_FALSE(solver->set_constants(model).ok());
    ASSERT_TRUE(solver->set_inputs({}).ok());
    EXPECT_TRUE(solver->set_constants(model).ok());
    EXPECT_EQ(&solver->model(), model.get());
  }
}

}  // namespace
}  // namespace aspic
