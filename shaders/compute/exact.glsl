// Quotients and roots rounded to nearest on every device. The canary (compute/canary.comp) decides at start-up:
//   ASPIC_CORRECT_DIV, ASPIC_CORRECT_SQRT  the device's own operation is not exact and has to be corrected
//   ASPIC_FUSED_FMA                        fma rounds once, so that it gives exact residuals; else double does
// Correction: a Newton step from the device's value, then of it and its neighbour on the side of the exact value the one
// with the smaller residual (Markstein, IBM J. Res. Dev. 34, 1990). Mantissas alone are divided, exponents are added as integers, so
// that neither a huge divisor nor a denormal result comes in the way. Denormal numbers count as zero (docs/determinism.md).
#include "compute/device_arithmetic.glsl"

#if defined(ASPIC_CORRECT_DIV) || defined(ASPIC_CORRECT_SQRT)
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

// Splits a normal, positive number, given by its bits: mantissa in [1, 2) and exponent.
float split(uint bits, out int exponent) {
  exponent = int(bits >> 23) - 127;
  return uintBitsToFloat((bits & 0x7fffffu) | 0x3f800000u);
}

// Bits of q·2^exponent for a normal positive q; zero in place of a denormal number.
uint join(float q, int exponent) {
  uint bits = floatBitsToUint(q);
  int biased = int(bits >> 23) + exponent;
  if (biased >= 255) return 0x7f800000u;
  if (biased < 1) return 0u;
  return (uint(biased) << 23) | (bits & 0x7fffffu);
}

// Whether |x|, given by its bits, is zero, denormal, infinite or no number.
bool special(uint bits) {
  return bits < 0x00800000u || bits >= 0x7f800000u;
}

// The neighbour of a positive q on the side of the exact value, which r has the sign of.
float neighbour(float q, float r) {
  return uintBitsToFloat(r < 0.0 ? floatBitsToUint(q) - 1u : floatBitsToUint(q) + 1u);
}

void take_better(float candidate, float candidate_residual, inout float best, inout float best_residual) {
  if (abs(candidate_residual) < abs(best_residual)) {
    best = candidate;
    best_residual = candidate_residual;
  }
}
#endif

float exact_div(float a, float b) {
#ifndef ASPIC_CORRECT_DIV
  return device_div(a, b);
#else
  uint a_bits = floatBitsToUint(a);
  uint b_bits = floatBitsToUint(b);
  uint sign = (a_bits ^ b_bits) & 0x80000000u;
  a_bits &= 0x7fffffffu;
  b_bits &= 0x7fffffffu;
  if (special(a_bits) || special(b_bits)) return device_div(a, b);
  int a_exponent;
  int b_exponent;
  precise float n = split(a_bits, a_exponent);
  precise float d = split(b_bits, b_exponent);
  precise float y = device_div(1.0, d);
  precise float q = n * y;
  precise float r = residual(n, q, d);
  q = q + r * y;
  r = residual(n, q, d);
  precise float other = neighbour(q, r);
  take_better(other, residual(n, other, d), q, r);
  return uintBitsToFloat(join(q, a_exponent - b_exponent) | sign);
#endif
}

float exact_sqrt(float x) {
#ifndef ASPIC_CORRECT_SQRT
  return device_sqrt(x);
#else
  uint bits = floatBitsToUint(x);
  if (special(bits)) return device_sqrt(x);
  int exponent;
  precise float m = split(bits, exponent);
  // An even exponent halves exactly; an odd one leaves its factor 2 under the root.
  if ((exponent & 1) != 0) m = m * 2.0;
  precise float c = device_sqrt(m);
  precise float r = residual(m, c, c);
  precise float twice = c * 2.0;
  c = c + device_div(r, twice);
  r = residual(m, c, c);
  precise float other = neighbour(c, r);
  take_better(other, residual(m, other, other), c, r);
  return uintBitsToFloat(join(c, exponent >> 1));
#endif
}
