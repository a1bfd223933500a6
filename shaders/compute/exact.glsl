// Quotients and roots rounded to nearest on every device. The canary (compute/canary.comp) decides at start-up:
//   ASPIC_CORRECT_DIV, ASPIC_CORRECT_SQRT  the device's own operation is not exact and has to be corrected
//   ASPIC_FUSED_FMA                        fma rounds once, so that it gives exact residuals; else double does
// Correction: a Newton step from the device's value, then of it and its neighbour on the side of the exact value the one
// with the smaller residual (Markstein, IBM J. Res. Dev. 34, 1990). Mantissas alone are divided, exponents are added as integers, so
// that neither a huge divisor nor a denormal result comes in the way.
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

// Splits a finite, positive number, given by its bits: mantissa in [1, 2) and exponent, denormals included.
float split(uint bits, out int exponent) {
  uint fraction = bits & 0x7fffffu;
  exponent = int(bits >> 23) - 127;
  if (exponent == -127) {
    int shift = 23 - findMSB(fraction);
    fraction = (fraction << shift) & 0x7fffffu;
    exponent = -126 - shift;
  }
  return uintBitsToFloat(fraction | 0x3f800000u);
}

// Bits of q·2^exponent for a normal positive q, rounded to nearest even; r has the sign of (exact value − q).
uint join(float q, int exponent, float r) {
  uint bits = floatBitsToUint(q);
  int biased = int(bits >> 23) + exponent;
  if (biased >= 255) return 0x7f800000u;
  uint fraction = bits & 0x7fffffu;
  if (biased >= 1) return (uint(biased) << 23) | fraction;
  if (biased < -24) return 0u;
  uint whole = fraction | 0x800000u;
  int shift = 1 - biased;
  uint kept = whole >> shift;
  uint rest = whole & ((1u << shift) - 1u);
  uint tie = 1u << (shift - 1);
  bool up = rest > tie || (rest == tie && (r > 0.0 || (r == 0.0 && (kept & 1u) == 1u)));
  return up ? kept + 1u : kept;
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
  if (a_bits == 0u || b_bits == 0u || a_bits >= 0x7f800000u || b_bits >= 0x7f800000u) return device_div(a, b);
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
  return uintBitsToFloat(join(q, a_exponent - b_exponent, r) | sign);
#endif
}

float exact_sqrt(float x) {
#ifndef ASPIC_CORRECT_SQRT
  return device_sqrt(x);
#else
  uint bits = floatBitsToUint(x);
  if ((bits & 0x7fffffffu) == 0u) return x;
  if (bits >= 0x7f800000u) return device_sqrt(x);
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
  return uintBitsToFloat(join(c, exponent >> 1, r));
#endif
}
