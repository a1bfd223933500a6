// Position and velocity of another particle. Software rasterizers read word by word, of 32 or 64 bits: ASPIC_WIDE_LOADS
// has them read pairs of numbers.
#ifdef ASPIC_WIDE_LOADS
layout(std430, binding = BINDING_STAGE_STATE) restrict readonly buffer WideState { dvec4 wide_state[]; };
vec2 halves(double pair) { return uintBitsToFloat(unpackDouble2x32(pair)); }

void read_neighbor(uint i, out vec3 x, out vec3 v) {
  precise dvec4 wide = wide_state[i];
  x = vec3(halves(wide.x), halves(wide.y).x);
  v = vec3(halves(wide.z), halves(wide.w).x);
}
#else
void read_neighbor(uint i, out vec3 x, out vec3 v) {
  Particle other = stage_state[i];
  x = other.position.xyz;
  v = other.velocity.xyz;
}
#endif
