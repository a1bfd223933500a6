// The pull of include/aspic/inputs.h, summed after its particle's springs: a spring of rest length 0 whose other end rests
// at the anchor.
#include "compute/spring.glsl"

layout(std140, binding = BINDING_PULL) uniform PullBlock { Pull pull; };

SpringClass pull_spring() { return SpringClass(pull.stiffness, pull.damping, 0.0, 0u); }

// f [N] on particle i at x, v, and the pull if it is the one pulled.
vec3 with_pull(uint i, vec3 x, vec3 v, vec3 f_in) {
  precise vec3 f = f_in;
  if (i == pull.particle) f += spring_force(pull_spring(), x, v, pull.anchor.xyz, vec3(0.0)).xyz;
  return f;
}
