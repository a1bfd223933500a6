// Computes what src/gpu/canary.cpp compares with the processor's IEEE results. Numbers travel as bits, so that nothing
// but the operations in question touches them.
#include "compute/dispatch.glsl"
#include "compute/exact.glsl"

struct Outcome {
  uint quotient;
  uint reciprocal;
  uint root;
  uint product;
  uint sum;
  uint product_sum;
  uint fused;
  uint vector_sum;
};

layout(std430, binding = 0) readonly buffer Operands {
  uvec4 operands[];  // a, b, c
};
layout(std430, binding = 1) writeonly buffer Outcomes {
  Outcome outcomes[];
};
layout(location = 0) uniform uint count;

void main() {
  uint i = item_index();
  if (i >= count) return;
  precise float a = uintBitsToFloat(operands[i].x);
  precise float b = uintBitsToFloat(operands[i].y);
  precise float c = uintBitsToFloat(operands[i].z);
  outcomes[i].quotient = floatBitsToUint(exact_div(a, b));
  outcomes[i].reciprocal = floatBitsToUint(exact_div(1.0, b));
  outcomes[i].root = floatBitsToUint(exact_sqrt(abs(a)));
  outcomes[i].product = floatBitsToUint(device_mul(a, b));
  outcomes[i].sum = floatBitsToUint(device_add(a, c));
  outcomes[i].product_sum = floatBitsToUint(device_mul_add(a, b, c));
  outcomes[i].fused = floatBitsToUint(device_fma(a, b, c));
  outcomes[i].vector_sum = floatBitsToUint(device_mul_add(a, vec3(c, b, a), vec3(b, c, a)).y);
}
