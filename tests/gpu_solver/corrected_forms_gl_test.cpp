// Devices whose quotients and roots are off end with the reference's bits.
#include <gtest/gtest.h>

#include <vector>

#include "gpu_solver/gpu_solver.h"
#include "support/gl_fixture.h"
#include "support/model_building.h"
#include "support/reference_runs.h"

namespace aspic {
namespace {

class CorrectedForms : public aspic::testing::GlTest {
 protected:
  /// The hash after these steps on a device with faults, corrected by these defines.
  static std::string hash_of(const Model& model, std::uint64_t steps, std::vector<gl::Define> faults,
                             std::vector<gl::Define> corrections) {
    GpuOptions options;
    options.force_path = ForcePath::gather;
    options.shader_directory = ASPIC_TEST_SHADERS;
    options.defines = std::move(faults);
    options.arithmetic.emplace().defines = std::move(corrections);
    auto solver = make_gpu_solver(context(), model, options);
    EXPECT_TRUE(solver.ok()) << solver.error().message();
    if (!solver.ok() || !(*solver)->advance(steps).ok()) return "";
    return state_hash_text(*(*solver)->state());
  }
};

TEST_F(CorrectedForms, HaveTheReferencesBits) {
  const gl::Define divide = {"ASPIC_CORRECT_DIV", "1"}, root = {"ASPIC_CORRECT_SQRT", "1"},
                   fused = {"ASPIC_FUSED_FMA", "1"};
  const std::vector<gl::Define> slow = {divide, root}, slow_fused = {divide, root, fused},
                                one_step = {divide, root, fused, {"ASPIC_QUICK", "1"}},
                                two_steps = {divide, root, fused, {"ASPIC_QUICK", "2"}};
  struct Row {
    const char *ulps, *rare;
    const std::vector<gl::Define>& corrections;
    Integrator integrator;
    bool equal;
  };
  const Row rows[] = {{"-2", "0u", two_steps, Integrator::explicit_euler, true},
                      {"1", "0u", two_steps, Integrator::implicit_euler, true},
                      {"1", "0xffffu", one_step, Integrator::explicit_euler, true},
                      {"-1", "0u", slow_fused, Integrator::explicit_euler, true},
                      {"2", "0u", slow, Integrator::explicit_euler, true},
                      {"1", "0u", {}, Integrator::explicit_euler, false}};
  for (const Row& row : rows) {
    SCOPED_TRACE(row.ulps);
    ModelSettings settings = test::low_cube(4, row.integrator, ContactModel::coulomb);
    const bool solved = row.integrator == Integrator::implicit_euler;
    if (solved) settings.simulation.timestep = 1.0 / 60.0;
    const Model model = test::build(settings);
    const std::uint64_t steps = solved ? 20 : 400;
    const std::string expected = state_hash_text(test::after(model, steps, Precision::single));
    const std::string hash = hash_of(
        model, steps,
        {{"FAULT_DIV", row.ulps}, {"FAULT_SQRT", row.ulps}, {"FAULT_RARE", row.rare}, {"FAULT_FUSED", "1"}},
        row.corrections);
    EXPECT_EQ(hash == expected, row.equal) << hash;
  }
}

}  // namespace
}  // namespace aspic
