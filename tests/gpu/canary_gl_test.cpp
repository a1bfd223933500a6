#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

#include "base/flush_denormals.h"
#include "gpu/canary.h"
#include "gpu/exact_forms.h"
#include "gpu/pass.h"
#include "support/gl_fixture.h"

namespace aspic::gl {
namespace {

class CanaryGl : public testing::GlTest {
 protected:
  /// The canary on a device with these faults.
  ArithmeticReport measure(std::vector<Define> faults) {
    auto report = measure_arithmetic(context(), ShaderLibrary(ASPIC_TEST_SHADERS), faults);
    EXPECT_TRUE(report.ok()) << report.error().message();
    return report ? *report : ArithmeticReport{};
  }
  Arithmetic choose(std::vector<Define> faults) {
    auto choice = choose_arithmetic(context(), ShaderLibrary(ASPIC_TEST_SHADERS), faults);
    EXPECT_TRUE(choice.ok()) << choice.error().message();
    return choice ? *choice : Arithmetic{};
  }
  static bool defines(const Arithmetic& a, const char* name) {
    return std::ranges::find(a.defines, name, &Define::name) != a.defines.end();
  }
};

TEST(CanaryOperands, AreManyFiniteAndTheSameEachTime) {
  const auto cases = canary_operands();
  EXPECT_GE(cases.size(), 10000u);
  const auto again = canary_operands();
  ASSERT_EQ(again.size(), cases.size());
  for (std::size_t i = 0; i < cases.size(); ++i) {
    ASSERT_TRUE(std::isfinite(cases[i].a) && std::isfinite(cases[i].b) && std::isfinite(cases[i].c)) << i;
    ASSERT_NE(cases[i].b, 0.0f) << i;
    ASSERT_TRUE(cases[i].a == again[i].a && cases[i].b == again[i].b && cases[i].c == again[i].c) << i;
  }
}

TEST_F(CanaryGl, FindsTheSoftwareDeviceExact) {
  auto choice = choose_arithmetic(context(), ShaderLibrary());
  ASSERT_TRUE(choice.ok()) << choice.error().message();
  EXPECT_TRUE(choice->exact());
  EXPECT_TRUE(choice->device.denormals_flushed());
  EXPECT_TRUE(choice->defines.empty());
  EXPECT_FALSE(choice->corrected.has_value());
  for (const OperationCheck* check :
       {&choice->device.quotient, &choice->device.reciprocal, &choice->device.root, &choice->device.product,
        &choice->device.sum, &choice->device.product_sum, &choice->device.vector_sum})
    EXPECT_GE(check->checked, 10000u) << check->name;
  EXPECT_GE(choice->device.denormals.checked, 1000u);
  for (const std::string& sentence : choice->sentences()) EXPECT_TRUE(sentence.ends_with('.')) << sentence;
}

TEST_F(CanaryGl, FindsQuotientsThatAreOneUnitOff) {
  const ArithmeticReport report = measure({{"FAULT_DIV", "1"}});
  EXPECT_FALSE(report.division_exact());
  EXPECT_TRUE(report.sqrt_exact());
  EXPECT_TRUE(report.products_uncontracted());
  EXPECT_EQ(report.quotient.ulps, 1u);
  EXPECT_EQ(report.quotient.expected, report.quotient.operands[0] / report.quotient.operands[1]);
  EXPECT_EQ(std::abs(report.quotient.got), std::nextafter(std::abs(report.quotient.expected), INFINITY));
}

TEST_F(CanaryGl, FindsRootsThatAreOneUnitOff) {
  const ArithmeticReport report = measure({{"FAULT_SQRT", "-1"}});
  EXPECT_FALSE(report.sqrt_exact());
  EXPECT_TRUE(report.division_exact());
  EXPECT_EQ(report.root.ulps, 1u);
}

TEST_F(CanaryGl, FindsContractionDenormalsAndWrongSums) {
  const ArithmeticReport contracted = measure({{"FAULT_CONTRACTION", "1"}});
  EXPECT_FALSE(contracted.products_uncontracted());
  EXPECT_TRUE(contracted.division_exact() && contracted.sqrt_exact() && contracted.basics_exact());
  const ArithmeticReport vectors = measure({{"FAULT_VECTOR", "1"}});
  EXPECT_FALSE(vectors.products_uncontracted());
  EXPECT_TRUE(vectors.product_sum.exact());
  const ArithmeticReport kept = measure({{"FAULT_KEEP", "1"}});
  EXPECT_FALSE(kept.denormals_flushed());
  EXPECT_TRUE(kept.all_exact());
  const ArithmeticReport sums = measure({{"FAULT_SUM", "1"}});
  EXPECT_FALSE(sums.basics_exact());
}

TEST_F(CanaryGl, CorrectedFormsAreExactFromWrongStarts) {
  // OpenGL drivers are allowed 2.5 units for a / b and more for roots (GLSL 4.30 §4.7.1): start further off
  // than that.
  for (const char* ulps : {"-4", "-1", "1", "2", "5"}) {
    SCOPED_TRACE(ulps);
    const Arithmetic choice = choose({{"FAULT_DIV", ulps}, {"FAULT_SQRT", ulps}});
    EXPECT_FALSE(choice.device.division_exact());
    EXPECT_FALSE(choice.device.sqrt_exact());
    EXPECT_TRUE(defines(choice, "ASPIC_CORRECT_DIV"));
    EXPECT_TRUE(defines(choice, "ASPIC_CORRECT_SQRT"));
    ASSERT_TRUE(choice.corrected.has_value());
    EXPECT_TRUE(choice.exact());
    // The corrected forms read denormal operands as zero and return zero in place of denormal results.
    EXPECT_TRUE(choice.corrected->denormals_flushed()) << choice.corrected->denormals.operands[0];
    for (const OperationCheck* check :
         {&choice.corrected->quotient, &choice.corrected->reciprocal, &choice.corrected->root})
      EXPECT_EQ(check->wrong, 0u) << check->name << " of " << check->operands[0] << ", " << check->operands[1]
                                  << ": got " << check->got << ", expected " << check->expected;
  }
}

TEST_F(CanaryGl, CorrectedFormsKeepTheMeaningOfSpecialValues) {
  using Limits = std::numeric_limits<float>;
  std::vector<float> values = {
      0.0f,          1.0f,         3.0f, Limits::infinity(), Limits::quiet_NaN(), Limits::denorm_min(),
      Limits::min(), Limits::max()};
  for (std::size_t i = 0, n = values.size(); i < n; ++i) values.push_back(-values[i]);
  std::vector<std::array<float, 2>> pairs;
  for (const float a : values)
    for (const float b : values) pairs.push_back({a, b});
  const auto count = static_cast<std::uint32_t>(pairs.size());

  const Define defines[] = {
      {"ASPIC_CORRECT_DIV", "1"}, {"ASPIC_CORRECT_SQRT", "1"}, {"FAULT_DIV", "1"}, {"FAULT_SQRT", "1"}};
  const auto program =
      Program::compute(context(), ShaderLibrary(ASPIC_TEST_SHADERS), "exact_pairs.comp", defines);
  ASSERT_TRUE(program.ok()) << program.error().message();
  const auto input = Buffer::of(context(), "pairs", pairs);
  const auto output = Buffer::create(context(), "results", std::uint64_t{8} * count);
  ASSERT_TRUE(input.ok() && output.ok());
  program->set(0, count);
  Pass(*program, {{.binding = 0, .buffer = &*input}, {.binding = 1, .buffer = &*output}}, ReadBy::read_back)
      .dispatch_for(count);
  const auto got = output->download_items<std::array<float, 2>>(count);
  const auto same = [](float x, float y) {
    return (std::isnan(x) && std::isnan(y)) ||
           std::bit_cast<std::uint32_t>(x) == std::bit_cast<std::uint32_t>(y);
  };
  const FlushDenormals flush;
  for (std::uint32_t i = 0; i < count; ++i) {
    const auto [a, b] = pairs[i];
    EXPECT_TRUE(same(got[i][0], a / b)) << a << " / " << b << " gave " << got[i][0];
    EXPECT_TRUE(same(got[i][1], std::sqrt(a))) << "the root of " << a << " gave " << got[i][1];
  }
}

std::vector<Define> quick_form(const char* steps, std::vector<Define> faults) {
  faults.insert(faults.end(), {{"ASPIC_CORRECT_DIV", "1"},
                               {"ASPIC_CORRECT_SQRT", "1"},
                               {"ASPIC_FUSED_FMA", "1"},
                               {"ASPIC_QUICK", steps},
                               {"FAULT_FUSED", "1"}});
  return faults;
}

// The device's count is that of the same text on the processor, which judges by its own quotients and roots.
TEST_F(CanaryGl, CountsWrongMantissas) {
  testing::device_fault = 1;
  const testing::WrongForms expected = testing::exact_forms()[1].count_wrong(1);
  testing::device_fault = 0;
  ASSERT_GT(expected.roots, 0u);
  for (const char* steps : {"1", "2"}) {
    const auto defines = quick_form(steps, {{"FAULT_DIV", "1"}, {"FAULT_SQRT", "1"}});
    const auto found = try_mantissas(context(), ShaderLibrary(ASPIC_TEST_SHADERS), defines);
    ASSERT_TRUE(found.ok()) << found.error().message();
    const bool exact = defines[5].value == "2";
    EXPECT_EQ(found->exact(), exact);
    EXPECT_EQ(found->tried, 1u << 24);
    EXPECT_EQ(found->wrong_roots, exact ? 0 : expected.roots);
    // A wrong root can be another number on the device, whose reciprocal then differs as well.
    const auto difference = static_cast<std::int64_t>(found->wrong_reciprocals) -
                            static_cast<std::int64_t>(exact ? 0 : expected.reciprocals_of_roots);
    EXPECT_LE(std::abs(difference), static_cast<std::int64_t>(exact ? 0 : expected.roots));
  }
  EXPECT_FALSE(MantissaReport{}.exact()) << "nothing was tried";
}

TEST_F(CanaryGl, TakesTheQuickFormOfFewestStepsThatIsExact) {
  const auto steps_chosen = [&](const char* ulps, const char* rare, bool fused = true) {
    std::vector<Define> faults = {{"FAULT_DIV", ulps}, {"FAULT_RARE", rare}};
    if (fused) faults.push_back({"FAULT_FUSED", "1"});
    const Arithmetic choice = choose(std::move(faults));
    EXPECT_TRUE(choice.exact());
    const auto quick = std::ranges::find(choice.defines, "ASPIC_QUICK", &Define::name);
    const bool slow = quick == choice.defines.end();
    EXPECT_NE(choice.sentences()[0].find(slow ? "the slow corrected form" : "the quick corrected form"),
              std::string::npos)
        << choice.sentences()[0];
    return slow ? "slow" : quick->value;
  };
  EXPECT_EQ(steps_chosen("1", "0xffffu"), "1");
  EXPECT_EQ(steps_chosen("1", "0u"), "2");
  EXPECT_EQ(steps_chosen("1", "0u", false), "slow") << "fma rounds twice";
}

TEST_F(CanaryGl, OnlyWhatIsWrongIsCorrected) {
  const Arithmetic choice = choose({{"FAULT_SQRT", "1"}});
  EXPECT_FALSE(defines(choice, "ASPIC_CORRECT_DIV"));
  EXPECT_TRUE(defines(choice, "ASPIC_CORRECT_SQRT"));
  EXPECT_TRUE(choice.exact());
  EXPECT_FALSE(choice.device.all_exact());
}

TEST_F(CanaryGl, SaysWhenNothingHelps) {
  const Arithmetic choice = choose({{"FAULT_CONTRACTION", "1"}});
  EXPECT_FALSE(choice.exact());
  const auto sentences = choice.sentences();
  EXPECT_TRUE(
      std::ranges::any_of(sentences, [](const auto& s) { return s.find("contracts") != std::string::npos; }));
}

}  // namespace
}  // namespace aspic::gl
