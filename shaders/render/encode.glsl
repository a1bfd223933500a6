// Linear light as sRGB stores it.

vec3 encoded(vec3 light) {
  vec3 low = 12.92 * light;
  vec3 high = 1.055 * pow(light, vec3(1.0 / 2.4)) - 0.055;
  return mix(high, low, lessThanEqual(light, vec3(0.0031308)));
}
