// C++: stands in for shaders/compute/device_arithmetic.glsl where tests/gpu/exact_forms.cpp compiles exact.glsl. The device's
// quotients and roots are `fault` units in the last place off.
float nudged(float x) { return uintBitsToFloat(floatBitsToUint(x) + static_cast<uint>(fault)); }

float device_div(float a, float b) {
  const float quotient = a / b;
  return special_value(quotient) ? quotient : nudged(quotient);
}

float device_sqrt(float x) {
  const float root = std::sqrt(x);
  return special_value(root) ? root : nudged(root);
}

float device_inversesqrt(float x) { return nudged(static_cast<float>(1.0 / std::sqrt(static_cast<double>(x)))); }

float device_mul(float a, float b) { return a * b; }

float device_fma(float a, float b, float c) { return ASPIC_FMA(a, b, c); }
