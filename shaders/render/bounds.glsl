// Floats as unsigned integers of the same order.
uint ordered(float value) {
  uint bits = floatBitsToUint(value);
  return (bits & 0x80000000u) != 0u ? ~bits : bits | 0x80000000u;
}
uvec3 ordered(vec3 v) { return uvec3(ordered(v.x), ordered(v.y), ordered(v.z)); }
float unordered(uint bits) {
  return uintBitsToFloat((bits & 0x80000000u) != 0u ? bits & 0x7fffffffu : ~bits);
}

layout(std430, binding = BINDING_BOUNDS) restrict buffer BoundsBlock { Bounds bounds[LIGHTS]; };

// Makes a light's box hold these corners too, of floats that are ordered().
void widen(int light, uvec3 lower, uvec3 upper) {
  atomicMin(bounds[light].lower.x, lower.x);
  atomicMin(bounds[light].lower.y, lower.y);
  atomicMin(bounds[light].lower.z, lower.z);
  atomicMax(bounds[light].upper.x, upper.x);
  atomicMax(bounds[light].upper.y, upper.y);
  atomicMax(bounds[light].upper.z, upper.z);
}
