// A device with faults, chosen by defines; without any it is the real one.
//   FAULT_DIV, FAULT_SQRT   units in the last place that are added to every quotient, every root and inverse root
//   FAULT_RARE              of these only where the result has none of these bits
//   FAULT_CONTRACTION       a·b + c is rounded once
//   FAULT_VECTOR            the same, of vectors alone
//   FAULT_KEEP              denormal products do not become zero
//   FAULT_FUSED             no fault: fma rounds once, where the device's own rounds twice
//   FAULT_SUM               units in the last place that are added to every sum
float nudged(float x, int ulps) {
  uint bits = floatBitsToUint(x);
  uint size = bits & 0x7fffffffu;
  if (size < 16u || size >= 0x7f7ffff0u) return x;
#ifdef FAULT_RARE
  if ((bits & FAULT_RARE) != 0u) return x;
#endif
  return uintBitsToFloat(uint(int(bits) + ulps));
}

float device_div(float a, float b) {
#ifdef FAULT_DIV
  precise float wanted = a / b;
  return nudged(wanted, FAULT_DIV);
#else
  precise float quotient = a / b;
  return quotient;
#endif
}

float device_sqrt(float x) {
#ifdef FAULT_SQRT
  precise float wanted = sqrt(x);
  return nudged(wanted, FAULT_SQRT);
#else
  precise float root = sqrt(x);
  return root;
#endif
}

float device_inversesqrt(float x) {
#ifdef FAULT_SQRT
  precise float wanted = float(1.0LF / sqrt(double(x)));
  return nudged(wanted, FAULT_SQRT);
#else
  precise float inverse = inversesqrt(x);
  return inverse;
#endif
}

float device_mul(float a, float b) {
  precise float product = a * b;
#ifdef FAULT_KEEP
  precise double kept = abs(double(a) * double(b));
  if (kept > 1.5e-45lf && kept < 1.1e-38lf) return uintBitsToFloat(floatBitsToUint(product) | 1u);
#endif
  return product;
}

float device_add(float a, float b) {
#ifdef FAULT_SUM
  precise float wanted = a + b;
  return nudged(wanted, FAULT_SUM);
#else
  precise float total = a + b;
  return total;
#endif
}

// Double holds the product exactly; its sum is rounded once more, which is near enough to a fused unit to be noticed.
float device_fma(float a, float b, float c) {
#if defined(FAULT_FUSED)
  // The sum of doubles rounded to odd: then rounding it to single precision gives the rounding of the exact sum.
  precise double product = double(a) * double(b);
  precise double addend = double(c);
  precise double sum = product + addend;
  precise double rest = sum - product;
  precise double lost = (product - (sum - rest)) + (addend - rest);
  uvec2 bits = unpackDouble2x32(sum);
  if (lost != 0.0LF && (bits.x & 1u) == 0u) {
    bool away = (lost > 0.0LF) == (sum > 0.0LF);
    if (!away && bits.x == 0u) --bits.y;
    bits.x += away ? 1u : 0xffffffffu;
    sum = packDouble2x32(bits);
  }
  precise float total = float(sum);
  return total;
#elif defined(FAULT_CONTRACTION)
  precise float total = float(double(a) * double(b) + double(c));
  return total;
#else
  precise float total = fma(a, b, c);
  return total;
#endif
}

float device_mul_add(float a, float b, float c) {
#ifdef FAULT_CONTRACTION
  return device_fma(a, b, c);
#else
  precise float product = a * b;
  precise float total = product + c;
  return total;
#endif
}

vec3 device_mul_add(float a, vec3 b, vec3 c) {
#ifdef FAULT_VECTOR
  precise vec3 total = vec3(double(a) * dvec3(b) + dvec3(c));
  return total;
#else
  precise vec3 total = a * b + c;
  return total;
#endif
}
