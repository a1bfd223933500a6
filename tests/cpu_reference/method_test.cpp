// A kind of methods that the program does not have, in the reference: whatever is common to all kinds works
// with it.
#include "cpu_reference/method.h"

#include <gtest/gtest.h>

#include <limits>

#include "support/model_building.h"
#include "support/reference_runs.h"

namespace aspic::reference {
namespace {

/// x' = x + h·v, v' = v, whatever forces there are, and a report of three iterations.
template <class T>
class Inertia : public Method<T> {
 public:
  Inertia(const Dynamics<T>& dynamics, const Model& model)
      : dynamics_(dynamics), h_(static_cast<T>(model.simulation.timestep)) {}

  Phase<T> step(const Phase<T>& s, SolveReport& report) override {
    report.newton_iterations = 3;
    return {s.x + h_ * s.v, s.v};
  }
  void respond(const Phase<T>& s, Phase<T>& end) const override { dynamics_.respond(s.x, s.v, end.x, end.v); }

 private:
  const Dynamics<T>& dynamics_;
  T h_;
};

/// A solve that finds nothing.
template <class T>
class Lost final : public Inertia<T> {
 public:
  using Inertia<T>::Inertia;
  Phase<T> step(const Phase<T>& s, SolveReport& report) override {
    report.residual = std::numeric_limits<double>::quiet_NaN();
    return s;
  }
};

template <class T, template <class> class M>
KindRow<T> kind() {
  return {[](const Dynamics<T>& dynamics, const Model& model) {
            return std::unique_ptr<Method<T>>(std::make_unique<M<T>>(dynamics, model));
          },
          [](const Model&) { return std::uint64_t{7}; }};
}

/// Particles that no spring holds and nothing pulls, and a ball in their way to the ground.
ModelSettings without_forces() {
  ModelSettings settings = test::cube_on_plane(3, 2.2);
  settings.simulation.gravity = {};
  settings.contact.restitution = 0.5;
  CubeSettings& cube = settings.cubes[0];
  cube.structural = cube.shear = cube.bending = {0.0, 0.0};
  cube.velocity = {0.3, -2.0, 0.1};
  BallSettings& ball = settings.balls.emplace_back();
  ball.position = {4.0, 1.0, 0.0};
  ball.velocity = {-5.0, 0.5, 0.0};
  return settings;
}

// Where there are no forces that is explicit Euler, with the terrain, balls and step numbers of the product.
TEST(AnotherKind, RunsWhereverTheSolverTakesMethods) {
  const Model model = test::build(without_forces());
  const auto same = [&]<class T>(T, Precision precision) {
    const auto stub = solver_with(kind<T, Inertia>(), shared(model));
    const auto product = test::solver_for(model, precision);
    EXPECT_EQ(test::advanced(*stub, 700), test::advanced(*product, 700));
    const State middle = *product->state();
    const State start = initial_state(model, precision);
    EXPECT_NE(middle.velocity[0], start.velocity[0]) << "no particle met the ground";
    EXPECT_NE(middle.ball_velocity[0], start.ball_velocity[0]) << "the ball met no particle";
    ASSERT_TRUE(stub->load(start).ok());
    EXPECT_EQ(*stub->state(), start);
    EXPECT_EQ(test::advanced(*stub, 700), middle);
  };
  same(float(), Precision::single);
  same(double(), Precision::double_);
}

TEST(AnotherKind, IsCountedInTheMemoryOfTheSolver) {
  const Model model = test::build(without_forces());
  // A stage more is a velocity and an acceleration more.
  Model midpoint = model;
  midpoint.simulation.integrator = Integrator::midpoint;
  const std::uint64_t stage = std::uint64_t{6} * sizeof(float) * model.particle_count();
  const std::uint64_t one = reference_bytes(model, Precision::single);
  EXPECT_EQ(reference_bytes(midpoint, Precision::single), one + stage);
  EXPECT_EQ(solver_with(kind<float, Inertia>(), shared(model))->bytes(), one - stage + 7);
}

TEST(AnotherKind, ReportsItsSolvesWhereTheRowSaysSo) {
  Model model = test::build(without_forces());
  auto solver = solver_with(kind<double, Inertia>(), shared(model));
  test::advanced(*solver, 5);
  EXPECT_FALSE(solver->solve_statistics().has_value());
  model.simulation.integrator = Integrator::implicit_euler;
  solver = solver_with(kind<double, Inertia>(), shared(model));
  test::advanced(*solver, 5);
  EXPECT_EQ(solver->solve_statistics()->steps, 5u);
  EXPECT_EQ(solver->solve_statistics()->newton_iterations, 15u);
}

TEST(AnotherKind, DivergesWhereItsResidualIsNotFinite) {
  const Model model = test::build(without_forces());
  const auto solver = solver_with(kind<double, Lost>(), shared(model));
  const auto divergence = solver->advance(3)->divergence;
  ASSERT_TRUE(divergence.has_value());
  EXPECT_TRUE(divergence->residual);
  EXPECT_EQ(divergence->step, 1u);
  EXPECT_EQ(*solver->state(), initial_state(model, Precision::double_));
}

}  // namespace
}  // namespace aspic::reference
