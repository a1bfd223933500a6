// The pulls of include/aspic/inputs.h, summed after a particle's springs in the order of the list: springs of rest length 0
// whose other end rests at the anchor.
#include "compute/terms/springs.glsl"

layout(std140, binding = BINDING_PULLS) uniform PullBlock {
  uint pull_count;
  uint pull_padding0, pull_padding1, pull_padding2;
  Pull pulls[MAX_PULLS];
};

SpringClass spring_of(Pull pull) { return SpringClass(pull.stiffness, pull.damping, 0.0, 0u); }

// f [N] on particle i at x, v, and the pulls on it.
vec3 with_pulls(uint i, vec3 x, vec3 v, vec3 f_in) {
  precise vec3 f = f_in;
  for (uint k = 0u; k < pull_count; ++k) {
    if (i == pulls[k].particle) f += spring_force(spring_of(pulls[k]), x, v, pulls[k].anchor.xyz, vec3(0.0)).xyz;
  }
  return f;
}
