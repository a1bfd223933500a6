// What every kernel of the solver shares: arithmetic whose order of operations is fixed (docs/determinism.md).
#include "compute/dispatch.glsl"
#include "compute/exact.glsl"

// (aₓbₓ + a_y b_y) + a_z b_z
float dot3(vec3 a, vec3 b) {
  precise float sum = (a.x * b.x + a.y * b.y) + a.z * b.z;
  return sum;
}

// (a_y b_z − a_z b_y, a_z b_x − a_x b_z, a_x b_y − a_y b_x)
vec3 cross3(vec3 a, vec3 b) {
  precise vec3 product = vec3(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
  return product;
}

// √((aₓ² + a_y²) + a_z²)
float norm3(vec3 a) {
  precise float root = exact_sqrt(dot3(a, a));
  return root;
}

#include "compute/terms/body_force.glsl"

// Whether item i of `count` counts itself.
bool is_counted(uint i, uint count) { return i % COUNTED_ITEMS == 0u || i + 1u == count; }

bool finite(vec3 a) {
  uvec3 exponent = floatBitsToUint(a) & 0x7f800000u;
  return all(notEqual(exponent, uvec3(0x7f800000u)));
}

// Divergence (docs/physics.md, section 6): NO_STEP if x, v are sane, else particle i's word for the lowest-particle search:
// 2·i, + 1 if the numbers are finite and only too fast.
uint divergence_word(uint i, vec3 x, vec3 v) {
  bool all_finite = finite(x) && finite(v);
  if (all_finite && !(dot3(v, v) > divergence_speed_squared)) return NO_STEP;
  return 2u * i + (all_finite ? 1u : 0u);
}
