// The device's own operations, as they come. Everything exact builds on these and on nothing else, so that
// a test can put a device with faults in their place. Mesa takes no `precise` on a function's type, so a function
// computes into a precise variable and returns that.
float device_div(float a, float b) {
  precise float quotient = a / b;
  return quotient;
}

float device_sqrt(float x) {
  precise float root = sqrt(x);
  return root;
}

// A start for roots; no exact kernel uses it otherwise.
float device_inversesqrt(float x) {
  precise float inverse = inversesqrt(x);
  return inverse;
}

float device_mul(float a, float b) {
  precise float product = a * b;
  return product;
}

float device_add(float a, float b) {
  precise float total = a + b;
  return total;
}

// Two roundings, where the compiler keeps to `precise`.
float device_mul_add(float a, float b, float c) {
  precise float product = a * b;
  precise float total = product + c;
  return total;
}

// The same by component, in one expression, as kernels write it.
vec3 device_mul_add(float a, vec3 b, vec3 c) {
  precise vec3 total = a * b + c;
  return total;
}

// One rounding on hardware with a fused unit, two elsewhere (llvmpipe): the canary finds out which.
float device_fma(float a, float b, float c) {
  precise float total = fma(a, b, c);
  return total;
}
