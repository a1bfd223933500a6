// Floats as unsigned integers of the same order.
uint ordered(float value) {
  uint bits = floatBitsToUint(value);
  return (bits & 0x80000000u) != 0u ? ~bits : bits | 0x80000000u;
}
uvec3 ordered(vec3 v) { return uvec3(ordered(v.x), ordered(v.y), ordered(v.z)); }
float unordered(uint bits) {
  return uintBitsToFloat((bits & 0x80000000u) != 0u ? bits & 0x7fffffffu : ~bits);
}
