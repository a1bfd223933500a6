#pragma once
// Whether a device computes as IEEE 754 says (docs/determinism.md), found out by asking it.
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"
#include "gpu/context.h"
#include "gpu/shader_source.h"

namespace aspic::gl {

/// One case: a / b, 1 / b, √|a|, a·b, a + c, a·b + c.
struct CanaryOperands {
  float a;
  float b;  ///< not zero
  float c;
  float unused = 0.0f;  ///< to the size of a vec4
};

/// The same cases on every machine: all finite, b ≠ 0.
std::vector<CanaryOperands> canary_operands();

/// What one operation gave against IEEE single precision, round to nearest even, denormal numbers flushed.
struct OperationCheck {
  std::string_view name;      ///< "quotients a / b"
  std::uint32_t checked = 0;  ///< cases compared
  std::uint32_t wrong = 0;    ///< cases with other bits
  /// The worst case (largest distance in units in the last place); legal to read if wrong > 0.
  std::array<float, 3> operands = {};
  float got = 0;
  float expected = 0;
  std::uint32_t ulps = 0;

  bool exact() const { return wrong == 0; }
};

/// What the canary found. Cases with a denormal operand, intermediate or result count under `denormals`
/// alone: a device that keeps them may still be exact everywhere else.
struct ArithmeticReport {
  OperationCheck quotient{"quotients a / b"};
  OperationCheck reciprocal{"reciprocals 1 / b"};
  OperationCheck root{"square roots of |a|"};
  OperationCheck product{"products a b"};
  OperationCheck sum{"sums a + c"};
  OperationCheck product_sum{"products with sums a b + c"};      ///< a·b + c in two roundings
  OperationCheck vector_sum{"products with sums of vectors"};    ///< the same by component
  OperationCheck denormals{"operations with denormal numbers"};  ///< any of the above
  bool fma_fused = true;                                         ///< fma() rounds once

  bool division_exact() const { return quotient.exact() && reciprocal.exact(); }
  bool sqrt_exact() const { return root.exact(); }
  bool products_uncontracted() const { return product_sum.exact() && vector_sum.exact(); }
  bool basics_exact() const { return product.exact() && sum.exact(); }
  bool denormals_flushed() const { return denormals.exact(); }
  /// Same bits as the reference wherever no denormal occurs.
  bool all_exact() const {
    return division_exact() && sqrt_exact() && products_uncontracted() && basics_exact();
  }
};

/// Runs shaders/compute/canary.comp on a fixed set of some 20,000 operand triples (hard cases next to
/// rounding boundaries, denormals, huge values) with the given defines. Errors: those of Program::compute and
/// Buffer::create.
Result<ArithmeticReport> measure_arithmetic(Context& context, const ShaderLibrary& library,
                                            std::span<const Define> defines = {});

/// What the exact forms give with every mantissa of a root, and of a reciprocal of a root: integers judge it
/// on the device (shaders/compute/canary_mantissas.comp).
struct MantissaReport {
  std::uint32_t tried = 0;
  std::uint32_t wrong_roots = 0;
  std::uint32_t wrong_reciprocals = 0;

  bool exact() const { return tried == 1u << 24 && wrong_roots == 0 && wrong_reciprocals == 0; }
};

/// Runs the exact forms of these defines on 2^24 mantissas. Errors: as measure_arithmetic.
Result<MantissaReport> try_mantissas(Context& context, const ShaderLibrary& library,
                                     std::span<const Define> defines);

/// How kernels have to be compiled on a device, and what to say about it.
struct Arithmetic {
  ArithmeticReport device;                    ///< the device's own operations
  std::optional<ArithmeticReport> corrected;  ///< measured again with `defines`, where they are needed
  /// ASPIC_CORRECT_DIV, ASPIC_CORRECT_SQRT, ASPIC_FUSED_FMA, ASPIC_QUICK (shaders/compute/exact.glsl), as
  /// needed
  std::vector<Define> defines;
  /// How far off a single operation may be in kernels compiled with `defines`, in units in the last place:
  /// the worst case that was found. A contracted product and sum counts as one, since what it leaves out is
  /// one rounding. 0: exact.
  std::uint32_t worst_ulps() const;
  /// Kernels compiled with `defines` give the reference's bits wherever no denormal occurs.
  bool exact() const { return corrected ? corrected->all_exact() : device.all_exact(); }
  /// Complete sentences for `aspic info`: which operations are exact, which differ and with which operands,
  /// and what is done about it.
  std::vector<std::string> sentences() const;
};

/// Measures the device, and where quotients or roots are not exact, the corrected forms too: the quick form
/// with fewest steps that is exact for every mantissa, or the slow form. `extra` goes to all measurements.
/// Errors: as measure_arithmetic.
Result<Arithmetic> choose_arithmetic(Context& context, const ShaderLibrary& library,
                                     std::span<const Define> extra = {});

}  // namespace aspic::gl
