// a / b and √a of each pair, through the exact forms.
#include "compute/dispatch.glsl"
#include "compute/exact.glsl"
layout(std430, binding = 0) readonly buffer Pairs {
  uvec2 pairs[];
};
layout(std430, binding = 1) writeonly buffer Results {
  uvec2 results[];
};
layout(location = 0) uniform uint count;

void main() {
  uint i = item_index();
  if (i >= count) return;
  precise float a = uintBitsToFloat(pairs[i].x);
  precise float b = uintBitsToFloat(pairs[i].y);
  results[i] = uvec2(floatBitsToUint(exact_div(a, b)), floatBitsToUint(exact_sqrt(a)));
}
