// The device's rows, given a device that computes another model than it was asked for.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <memory>
#include <vector>

#include "support/gl_fixture.h"
#include "verify/check.h"
#include "verify/experiments.h"

namespace aspic::verify {
namespace {

class FaultyDevice : public aspic::testing::GlTest {
 protected:
  static Row row_of(const std::string& name, const Subject& subject) {
    const std::vector<std::string> names = {name};
    const auto checks = select(battery(), names, false);
    EXPECT_TRUE(checks.ok()) << name;
    return evaluate(checks->front(), subject);
  }
};

TEST_F(FaultyDevice, AnotherStiffnessOrIntegratorIsNoticed) {
  Subject subject = product(&context(), ASPIC_PROGRAM);
  EXPECT_EQ(row_of("equality/force", subject).verdict, Verdict::passed);
  // The models must outlive the solvers made of them.
  std::vector<std::unique_ptr<Model>> models;
  subject.gpu = [&, right = subject.gpu](const Model& model, const GpuOptions& options) {
    models.push_back(std::make_unique<Model>(model));
    for (SpringClass& s : models.back()->spring_classes) s.stiffness *= 1 + 1e-5;
    return right(*models.back(), options);
  };
  EXPECT_EQ(row_of("equality/force", subject).verdict, Verdict::failed);
  const Row equality = row_of("equality/implicit-euler", subject);
  EXPECT_EQ(equality.verdict, Verdict::failed) << equality.measured;
}

TEST_F(FaultyDevice, AWorkGroupOrARunOfItsOwnIsNoticed) {
  Subject subject = product(&context(), ASPIC_PROGRAM);
  std::vector<std::unique_ptr<Model>> models;
  subject.gpu = [&, right = subject.gpu](const Model& model, const GpuOptions& options) {
    models.push_back(std::make_unique<Model>(model));
    if (options.group_size == 128) models.back()->simulation.gravity.y = -9.80001;
    return right(*models.back(), options);
  };
  EXPECT_EQ(row_of("repeat/group-sizes", subject).verdict, Verdict::failed);
  subject.program = "/nonexistent/aspic";
  EXPECT_EQ(row_of("repeat/driver-threads", subject).verdict, Verdict::failed);
}

// A solver that does nothing has one hash in all runs.
TEST_F(FaultyDevice, RunsThatGoNowhereAreNoticed) {
  Subject subject = product(&context(), ASPIC_PROGRAM);
  EXPECT_EQ(row_of("repeat/runs", subject).verdict, Verdict::passed);
  std::vector<std::unique_ptr<Model>> models;
  subject.gpu = [&, right = subject.gpu](const Model& model, const GpuOptions& options) {
    models.push_back(std::make_unique<Model>(model));
    models.back()->simulation.timestep = 1e-60;  // 0 in single precision
    models.back()->terrain.clear();              // which would lift particles out of it
    return right(*models.back(), options);
  };
  for (const char* name : {"repeat/runs", "repeat/group-sizes"}) {
    const Row row = row_of(name, subject);
    EXPECT_EQ(row.verdict, Verdict::failed) << name << ": " << row.measured;
    EXPECT_NE(row.measured.find("nothing moved"), std::string::npos) << row.measured;
  }
}

/// A cube that meets the ground, on a device and on the reference.
Finding compared(const Subject& subject, Integrator integrator) {
  const auto model = build_model(cube_on_terrain(4, TerrainShape::plane, integrator, ContactModel::coulomb));
  const BackendRow& row = *find_backend("gpu");
  BitComparison comparison(subject, row);
  const std::uint64_t steps = aspic::row_of(integrator).traits.long_steps ? 40 : 400;
  const std::vector<GpuOptions> variants(1);
  const Status done = comparison.add(
      *model, [&](Solver& solver) { return run(solver, steps); }, variants);
  EXPECT_TRUE(done.ok()) << done.error().message();
  return comparison.finding();
}

// A device whose quotients and roots are off, and stay so: what it may differ by follows from how far they
// are off.
TEST_F(FaultyDevice, InexactArithmeticHasABound) {
  struct Fault {
    int quotient, root;  // units in the last place
  };
  for (const auto& [quotient, root] : {Fault{1, 0}, {1, -1}, {-3, 2}}) {
    const std::vector<gl::Define> faults = {{"FAULT_DIV", std::to_string(quotient)},
                                            {"FAULT_SQRT", std::to_string(root)}};
    const auto report = gl::measure_arithmetic(context(), gl::ShaderLibrary(ASPIC_TEST_SHADERS), faults);
    ASSERT_TRUE(report.ok()) << report.error().message();
    const gl::Arithmetic inexact = {*report, std::nullopt, {}};
    ASSERT_EQ(inexact.worst_ulps(), static_cast<std::uint32_t>(std::abs(quotient)));
    Subject subject = product(&context(), ASPIC_PROGRAM);
    bool told = true;
    subject.gpu = [&, right = subject.gpu](const Model& model, GpuOptions options) {
      options.shader_directory = ASPIC_TEST_SHADERS;
      options.defines = faults;
      if (told) options.arithmetic = inexact;
      return right(model, options);
    };
    for (const Integrator integrator :
         {Integrator::explicit_euler, Integrator::runge_kutta_4, Integrator::implicit_euler}) {
      const Finding found = compared(subject, integrator);
      EXPECT_TRUE(found.passed) << found.measured;
      EXPECT_EQ(found.measured.find("single steps"), 0u) << found.measured;
      RecordProperty(fmt::format("{} quotient {} root {}", name_of(integrator), quotient, root),
                     found.measured);
    }
    // The same from a device that the canary found exact is a fault.
    told = false;
    EXPECT_FALSE(compared(subject, Integrator::runge_kutta_4).passed);
  }
}

// A wrong constant is beyond what one unit in the last place explains.
TEST_F(FaultyDevice, TheBoundIsNoFreePass) {
  const auto report = gl::measure_arithmetic(context(), gl::ShaderLibrary(ASPIC_TEST_SHADERS),
                                             std::vector<gl::Define>{{"FAULT_DIV", "1"}});
  ASSERT_TRUE(report.ok());
  Subject subject = product(&context(), ASPIC_PROGRAM);
  std::vector<std::unique_ptr<Model>> models;
  subject.gpu = [&, right = subject.gpu](const Model& model, GpuOptions options) {
    models.push_back(std::make_unique<Model>(model));
    for (SpringClass& s : models.back()->spring_classes) s.stiffness *= 1.02;
    options.arithmetic = gl::Arithmetic{*report, std::nullopt, {}};
    return right(*models.back(), options);
  };
  const Finding found = compared(subject, Integrator::runge_kutta_4);
  EXPECT_FALSE(found.passed) << found.measured;
}

}  // namespace
}  // namespace aspic::verify
