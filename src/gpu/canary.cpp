#include "gpu/canary.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "base/flush_denormals.h"
#include "gpu/pass.h"

namespace aspic::gl {
namespace {

/// As in shaders/compute/canary.comp.
struct Outcome {
  std::uint32_t quotient, reciprocal, root, product, sum, product_sum, fused, vector_sum;
};
static_assert(sizeof(Outcome) == 32);

/// By the bits, since comparisons take denormal numbers for zero while those are flushed.
bool denormal(float x) {
  const std::uint32_t size = std::bit_cast<std::uint32_t>(x) & 0x7fffffffu;
  return size > 0 && size < 0x00800000u;
}

/// A float's place on the number line, so that differences count units in the last place.
std::int64_t place(std::uint32_t bits) {
  const auto size = static_cast<std::int64_t>(bits & 0x7fffffffu);
  return (bits >> 31) != 0 ? -size : size;
}

void judge(OperationCheck& check, const CanaryOperands& o, std::uint32_t got, float expected) {
  ++check.checked;
  const auto want = std::bit_cast<std::uint32_t>(expected);
  if (got == want || (std::isnan(std::bit_cast<float>(got)) && std::isnan(expected))) return;
  ++check.wrong;
  const auto ulps = static_cast<std::uint32_t>(std::abs(place(got) - place(want)));
  if (check.wrong > 1 && ulps <= check.ulps) return;
  check.ulps = ulps;
  check.operands = {o.a, o.b, o.c};
  check.got = std::bit_cast<float>(got);
  check.expected = expected;
}

/// What every operation gives in the floating-point environment of the caller.
struct Expected {
  float quotient, reciprocal, root, product, sum, product_sum, fused;

  explicit Expected(const CanaryOperands& o)
      : quotient(o.a / o.b),
        reciprocal(1.0f / o.b),
        root(std::sqrt(std::abs(o.a))),
        product(o.a * o.b),
        sum(o.a + o.c),
        product_sum(product + o.c),
        fused(std::fma(o.a, o.b, o.c)) {}
};

ArithmeticReport compare(std::span<const CanaryOperands> operands, std::span<const Outcome> outcomes) {
  const std::vector<Expected> kept(operands.begin(), operands.end());
  const FlushDenormals flush;
  const std::vector<Expected> flushed(operands.begin(), operands.end());
  // Devices differ in whether a result is tiny before or after rounding lifts it to the least normal number.
  const auto small = [](float x) { return denormal(x) || std::abs(x) == std::numeric_limits<float>::min(); };
  ArithmeticReport report;
  for (std::size_t i = 0; i < operands.size(); ++i) {
    const CanaryOperands& o = operands[i];
    const Outcome& got = outcomes[i];
    const auto file = [&](OperationCheck& check, std::uint32_t result, float Expected::*field,
                          bool small_operand) {
      judge(small_operand || small(kept[i].*field) ? report.denormals : check, o, result, flushed[i].*field);
    };
    const bool small_a = denormal(o.a);
    const bool small_b = denormal(o.b);
    const bool small_c = denormal(o.c);
    const bool small_product = small_a || small_b || small(kept[i].product);
    file(report.quotient, got.quotient, &Expected::quotient, small_a || small_b);
    file(report.reciprocal, got.reciprocal, &Expected::reciprocal, small_b);
    file(report.root, got.root, &Expected::root, small_a);
    file(report.product, got.product, &Expected::product, small_product);
    file(report.sum, got.sum, &Expected::sum, small_a || small_c);
    file(report.product_sum, got.product_sum, &Expected::product_sum, small_product || small_c);
    file(report.vector_sum, got.vector_sum, &Expected::product_sum, small_product || small_c);
    if (!small_product && !small_c && !small(kept[i].fused) &&
        got.fused != std::bit_cast<std::uint32_t>(flushed[i].fused))
      report.fma_fused = false;
  }
  return report;
}

constexpr const char* quick_define = "ASPIC_QUICK";

std::string sentence(const OperationCheck& check, std::string_view remedy) {
  if (check.exact())
    return fmt::format("The device's {} are exact: {} of {}.", check.name, check.checked, check.checked);
  return fmt::format(
      "The device's {} differ from IEEE 754 in {} of {} cases, at worst by {} units in the last place (a = "
      "{:.9g}, "
      "b = {:.9g}, c = {:.9g}: got {:.9g}, expected {:.9g}).{}",
      check.name, check.wrong, check.checked, check.ulps, check.operands[0], check.operands[1],
      check.operands[2], check.got, check.expected, remedy);
}

}  // namespace

Result<ArithmeticReport> measure_arithmetic(Context& context, const ShaderLibrary& library,
                                            std::span<const Define> defines) {
  const std::vector<CanaryOperands> operands = canary_operands();
  ASPIC_TRY(const auto found, context.programs().compute(library, "compute/canary.comp", defines));
  const Program& program = *found;
  ASPIC_TRY(const auto input, Buffer::of(context, "canary operands", operands));
  ASPIC_TRY(const auto output, Buffer::create(context, "canary outcomes", operands.size() * sizeof(Outcome)));
  const auto count = static_cast<std::uint32_t>(operands.size());
  program.set(0, count);
  Pass(program, {{.binding = 0, .buffer = &input}, {.binding = 1, .buffer = &output}}, ReadBy::read_back)
      .dispatch_for(count);
  return compare(operands, output.download_items<Outcome>(count));
}

Result<MantissaReport> try_mantissas(Context& context, const ShaderLibrary& library,
                                     std::span<const Define> defines) {
  constexpr std::uint32_t mantissas = 128;  // of an invocation
  ASPIC_TRY(const auto program,
            context.programs().compute(library, "compute/canary_mantissas.comp", defines));
  ASPIC_TRY(auto tally, Buffer::create(context, "canary tally", 4 * sizeof(std::uint32_t)));
  tally.clear();
  const std::uint32_t count = (1u << 24) / mantissas;
  program->set(0, count);
  Pass(*program, {{.binding = 0, .buffer = &tally}}, ReadBy::read_back).dispatch_for(count);
  const auto found = tally.download_items<std::uint32_t>(3);
  return MantissaReport{found[0], found[1], found[2]};
}

Result<Arithmetic> choose_arithmetic(Context& context, const ShaderLibrary& library,
                                     std::span<const Define> extra) {
  if (!context.info().is_software) {
    // Hardware mostly needs the quick form of one step, whose canaries compile while the first one does.
    std::vector<Define> guess = {{"ASPIC_CORRECT_DIV", "1"},
                                 {"ASPIC_CORRECT_SQRT", "1"},
                                 {"ASPIC_FUSED_FMA", "1"},
                                 {quick_define, "1"}};
    guess.insert(guess.end(), extra.begin(), extra.end());
    ASPIC_TRY(const auto first, context.programs().start(library, {.compute = "compute/canary.comp"}, extra));
    for (const char* path : {"compute/canary_mantissas.comp", "compute/canary.comp"}) {
      ASPIC_TRY(const auto begun, context.programs().start(library, {.compute = path}, guess));
    }
  }
  ASPIC_TRY(auto device, measure_arithmetic(context, library, extra));
  Arithmetic choice{device, std::nullopt, {}};
  if (!device.division_exact()) choice.defines.push_back({"ASPIC_CORRECT_DIV", "1"});
  if (!device.sqrt_exact()) choice.defines.push_back({"ASPIC_CORRECT_SQRT", "1"});
  if (choice.defines.empty()) return choice;
  const auto with_extra = [&](std::vector<Define> defines) {
    defines.insert(defines.end(), extra.begin(), extra.end());
    return defines;
  };
  if (device.fma_fused) {
    choice.defines.push_back({"ASPIC_FUSED_FMA", "1"});
    for (const char* steps : {"1", "2"}) {
      std::vector<Define> quick = choice.defines;
      quick.push_back({quick_define, steps});
      const std::vector<Define> all = with_extra(quick);
      ASPIC_TRY(const MantissaReport mantissas, try_mantissas(context, library, all));
      if (!mantissas.exact()) continue;
      ASPIC_TRY(auto corrected, measure_arithmetic(context, library, all));
      if (!corrected.division_exact() || !corrected.sqrt_exact()) continue;
      choice.corrected = corrected;
      choice.defines = std::move(quick);
      return choice;
    }
  }
  ASPIC_TRY(choice.corrected, measure_arithmetic(context, library, with_extra(choice.defines)));
  return choice;
}

std::uint32_t Arithmetic::worst_ulps() const {
  const ArithmeticReport& found = corrected ? *corrected : device;
  std::uint32_t worst = found.products_uncontracted() ? 0u : 1u;
  for (const OperationCheck* check :
       {&found.quotient, &found.reciprocal, &found.root, &found.product, &found.sum})
    worst = std::max(worst, check->ulps);
  return worst;
}

std::vector<std::string> Arithmetic::sentences() const {
  const auto quick = std::ranges::find(defines, quick_define, &Define::name);
  const std::string form = quick == defines.end() ? "slow corrected form"
                                                  : fmt::format("quick corrected form ({} Newton step{})",
                                                                quick->value, quick->value == "1" ? "" : "s");
  const auto remedy = [&](bool mended) {
    return mended ? fmt::format(" Kernels use the {}, which is exact.", form)
                  : fmt::format(" The {} is not exact either: results will differ from the reference.", form);
  };
  const std::string division = remedy(corrected && corrected->division_exact());
  constexpr std::string_view contracts =
      " The compiler contracts them despite `precise`: results will differ from the reference.";
  const std::string_view differs = " Aspic has no workaround: results will differ from the reference.";
  return {
      sentence(device.quotient, division),
      sentence(device.reciprocal, division),
      sentence(device.root, remedy(corrected && corrected->sqrt_exact())),
      sentence(device.product, differs),
      sentence(device.sum, differs),
      sentence(device.product_sum, contracts),
      sentence(device.vector_sum, contracts),
      device.denormals.exact()
          ? "The device flushes denormal numbers to zero, as every backend does."
          : sentence(device.denormals, " Results can differ from the reference where such numbers occur."),
      fmt::format("The device's fma rounds {}.", device.fma_fused ? "once" : "twice"),
  };
}

}  // namespace aspic::gl
