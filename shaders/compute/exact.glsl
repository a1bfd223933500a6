// Quotients and roots rounded to nearest on every device. Denormal numbers count as zero (docs/determinism.md). The canary
// (src/gpu/canary.cpp) decides at start-up:
//   ASPIC_CORRECT_DIV, ASPIC_CORRECT_SQRT  the device's own operation is not exact and has to be corrected
//   ASPIC_FUSED_FMA                        fma rounds once, so that it gives exact residuals; else double does
//   ASPIC_QUICK                            Newton steps of the quick form, 1 or 2; absent: the slow form
// Both forms take operands in the middle of the range. Of others, mantissas are computed with and exponents added as integers.
// Only the spring law, which is most of the work, tests for that range: elsewhere the second path would double the code, and
// NVIDIA's compiler takes a millisecond for each operation.
//   quick  residuals by fma alone (Markstein, IBM J. Res. Dev. 34, 1990). Two steps are exact for every operand from a start
//          within 2 units in the last place; one step is on devices for which the canary has found no exception.
//   slow   a Newton step, then of the value and its neighbor on the exact value's side the one with the smaller residual
// tests/gpu/exact_forms.cpp compiles this file as C++ and tries all mantissas: it keeps to what both languages share.
#include "compute/device_arithmetic.glsl"

#if defined(ASPIC_CORRECT_DIV) || defined(ASPIC_CORRECT_SQRT)

#ifdef ASPIC_QUICK
float middle_rcp(float b) {
  precise float y = device_div(1.0, b);
  precise float e = device_fma(-b, y, 1.0);
  y = device_fma(e, y, y);
#if ASPIC_QUICK > 1
  // Where y is too small the step takes the next larger factor: with y itself, 1/b of the mantissa 0x7fffff ends in a tie.
  e = device_fma(-b, y, 1.0);
  precise float factor = uintBitsToFloat(floatBitsToUint(y) + 1u - (floatBitsToUint(e) >> 31));
  y = device_fma(e, factor, y);
#endif
  return y;
}

// Exact where middle_rcp is: q is within one unit before the last residual (Markstein's theorem).
float middle_div(float a, float b) {
  precise float y = middle_rcp(b);
  precise float q = device_mul(a, y);
  precise float r = device_fma(-b, q, a);
  q = device_fma(r, y, q);
  r = device_fma(-b, q, a);
  q = device_fma(r, y, q);
  return q;
}

float middle_sqrt(float x) {
  precise float y = device_inversesqrt(x);
  precise float root = device_mul(x, y);
  precise float half_y = device_mul(0.5, y);
#if ASPIC_QUICK > 1
  precise float e = device_fma(-root, half_y, 0.5);
  half_y = device_fma(half_y, e, half_y);
  root = device_fma(root, e, root);
#endif
  precise float r = device_fma(-root, root, x);
  root = device_fma(r, half_y, root);
  return root;
}

// Whether 2⁻⁶² ≤ |x| < 2⁶², given the bits of |x|: no result, factor or residual is denormal or overflows then.
bool in_middle(uint size) { return size - 0x20800000u < 0x3e000000u; }
#else
// a − c·b, exact for c within a few units in the last place of a/b.
float residual(float a, float c, float b) {
#ifdef ASPIC_FUSED_FMA
  return device_fma(-c, b, a);
#else
  precise double product = double(c) * double(b);
  precise float difference = float(double(a) - product);
  return difference;
#endif
}

// The neighbor of a positive q on the side of the exact value, which r has the sign of.
float neighbor(float q, float r) {
  return uintBitsToFloat(r < 0.0 ? floatBitsToUint(q) - 1u : floatBitsToUint(q) + 1u);
}

float middle_div(float a, float b) {
  precise float y = device_div(1.0, b);
  precise float q = a * y;
  precise float r = residual(a, q, b);
  q = q + r * y;
  r = residual(a, q, b);
  precise float other = neighbor(q, r);
  return abs(residual(a, other, b)) < abs(r) ? other : q;
}

float middle_sqrt(float x) {
  precise float root = device_sqrt(x);
  precise float r = residual(x, root, root);
  precise float twice = root + root;
  root = root + device_div(r, twice);
  r = residual(x, root, root);
  precise float other = neighbor(root, r);
  return abs(residual(x, other, other)) < abs(r) ? other : root;
}
#endif

// The bits of |x|.
uint size_of(float x) { return floatBitsToUint(x) & 0x7fffffffu; }

// Whether |x| is zero, denormal, infinite or no number.
bool special(uint size) { return size < 0x00800000u || size >= 0x7f800000u; }

float flushed(float x) { return size_of(x) < 0x00800000u ? uintBitsToFloat(floatBitsToUint(x) & 0x80000000u) : x; }

float mantissa(uint bits) { return uintBitsToFloat((bits & 0x7fffffu) | 0x3f800000u); }

// Bits of q·2^exponent for a normal positive q.
uint scaled(float q, int exponent) {
  uint bits = floatBitsToUint(q);
  int biased = int(bits >> 23) + exponent;
  if (biased < 1) return 0u;
  if (biased > 254) return 0x7f800000u;
  return (uint(biased) << 23) | (bits & 0x7fffffu);
}

float any_div(float a, float b) {
  uint a_size = size_of(a);
  uint b_size = size_of(b);
  if (special(a_size) || special(b_size)) return device_div(flushed(a), flushed(b));
  precise float q = middle_div(mantissa(a_size), mantissa(b_size));
  uint size = scaled(q, int(a_size >> 23) - int(b_size >> 23));
  return uintBitsToFloat(size | ((floatBitsToUint(a) ^ floatBitsToUint(b)) & 0x80000000u));
}

float any_sqrt(float x) {
  uint bits = floatBitsToUint(x);
  if (size_of(x) < 0x00800000u) return flushed(x);
  if (bits >= 0x7f800000u) return device_sqrt(x);
  // An even exponent halves exactly; an odd one leaves its factor 2 under the root.
  int exponent = int(bits >> 23) - 127;
  uint odd = uint(exponent & 1) << 23;
  precise float root = middle_sqrt(uintBitsToFloat(floatBitsToUint(mantissa(bits)) + odd));
  return uintBitsToFloat(scaled(root, exponent >> 1));
}
#endif

float exact_div(float a, float b) {
#ifdef ASPIC_CORRECT_DIV
  return any_div(a, b);
#else
  return device_div(a, b);
#endif
}

float exact_sqrt(float x) {
#ifdef ASPIC_CORRECT_SQRT
  return any_sqrt(x);
#else
  return device_sqrt(x);
#endif
}

// √x, and 1 over that: a root of the middle is in the middle too.
vec2 exact_sqrt_rcp(float x) {
#if defined(ASPIC_CORRECT_DIV) && defined(ASPIC_CORRECT_SQRT) && defined(ASPIC_QUICK)
  if (in_middle(floatBitsToUint(x))) {
    precise float quick_root = middle_sqrt(x);
    return vec2(quick_root, middle_rcp(quick_root));
  }
  precise float root = any_sqrt(x);
  return vec2(root, any_div(1.0, root));
#else
  precise float root = exact_sqrt(x);
  return vec2(root, exact_div(1.0, root));
#endif
}
