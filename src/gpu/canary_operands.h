#pragma once
// The operands on which a device's arithmetic is judged.
#include <vector>

namespace aspic::gl {

/// One case: a / b, 1 / b, √|a|, a·b, a + c, a·b + c.
struct CanaryOperands {
  float a;
  float b;  ///< not zero
  float c;
};

/// The same cases on every machine: all finite, b ≠ 0.
std::vector<CanaryOperands> canary_operands();

}  // namespace aspic::gl
