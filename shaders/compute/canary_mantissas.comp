// Tries the exact forms with every mantissa: √x for x in [1, 4), and 1 over each root, which are all numbers in [1, 2). Integers
// judge the results: nothing that is tried takes part.
#include "compute/dispatch.glsl"
#include "compute/exact.glsl"

layout(std430, binding = 0) buffer Tally {
  uint tried;
  uint wrong_roots;
  uint wrong_reciprocals;
  uint unused;
};

// Number of mantissas for each invocation.
#define MANTISSAS 128u

// Whether G·2⁻²³ is the float next to √x, x = X·2^−46: (2G − 1)² < 4X < (2G + 1)², that is −G < X − G² ≤ G.
bool is_root(uint fraction, bool odd, uint bits) {
  if (bits >> 23 != 127u) return false;
  uint M = fraction | 0x800000u;
  uint G = (bits & 0x7fffffu) | 0x800000u;
  uint square_high = 0u, square_low = 0u, borrow = 0u;
  umulExtended(G, G, square_high, square_low);
  uint low = usubBorrow(odd ? M << 24 : M << 23, square_low, borrow);
  uint high = (odd ? M >> 8 : M >> 9) - square_high - borrow;
  int difference = int(low);
  return high + (low >> 31) == 0u && difference > -int(G) && difference <= int(G);
}

// Whether Y·2⁻²⁴ is the float next to 1/b, b = B·2⁻²³: |2Y·B − 2⁴⁸| < B, or equal where 1/b is a float.
bool is_reciprocal(uint b_bits, uint bits) {
  uint exponent = bits >> 23;
  if (exponent != 126u && exponent != 127u) return false;
  uint Y = ((bits & 0x7fffffu) | 0x800000u) << (exponent - 126u);
  uint B = (b_bits & 0x7fffffu) | 0x800000u;
  uint high = 0u, low = 0u;
  umulExtended(2u * Y, B, high, low);
  return high + (low >> 31) == 0x10000u && abs(int(low)) < int(B);
}

layout(location = 0) uniform uint count;

void main() {
  uint i = item_index();
  if (i >= count) return;
  uint roots = 0u;
  uint reciprocals = 0u;
  for (uint n = 0u; n < MANTISSAS; ++n) {
    uint place = i * MANTISSAS + n;
    precise vec2 root = exact_sqrt_rcp(uintBitsToFloat(0x3f800000u + place));
    uvec2 bits = floatBitsToUint(root);
    if (!is_root(place & 0x7fffffu, place >> 23 != 0u, bits.x)) ++roots;
    if (!is_reciprocal(bits.x, bits.y)) ++reciprocals;
  }
  atomicAdd(tried, MANTISSAS);
  if (roots > 0u) atomicAdd(wrong_roots, roots);
  if (reciprocals > 0u) atomicAdd(wrong_reciprocals, reciprocals);
}
