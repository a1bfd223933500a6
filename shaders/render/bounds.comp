// The box of all particles in each light's space: shadow maps are fitted to it without the processor's help.
#include "render/layout.glsl"
#include "render/bounds.glsl"
#include "render/particle.glsl"
#include "compute/dispatch.glsl"

layout(std430, binding = BINDING_PARTICLES) restrict readonly buffer Particles { Particle particles[]; };
layout(std430, binding = BINDING_BOUNDS) restrict buffer BoundsBlock { Bounds bounds[LIGHTS]; };

shared uvec3 group_lower[LIGHTS];
shared uvec3 group_upper[LIGHTS];

void main() {
  uint i = item_index();
  if (gl_LocalInvocationIndex < uint(LIGHTS)) {
    group_lower[gl_LocalInvocationIndex] = uvec3(0xffffffffu);
    group_upper[gl_LocalInvocationIndex] = uvec3(0u);
  }
  barrier();
  if (i < particle_count) {
    for (int light = 0; light < LIGHTS; ++light) {
      vec3 p = mat3(lights[light]) * particles[i].position.xyz;
      for (int axis = 0; axis < 3; ++axis) {
        atomicMin(group_lower[light][axis], ordered(p[axis]));
        atomicMax(group_upper[light][axis], ordered(p[axis]));
      }
    }
  }
  barrier();
  if (gl_LocalInvocationIndex < uint(LIGHTS)) {
    int light = int(gl_LocalInvocationIndex);
    for (int axis = 0; axis < 3; ++axis) {
      atomicMin(bounds[light].lower[axis], group_lower[light][axis]);
      atomicMax(bounds[light].upper[axis], group_upper[light][axis]);
    }
  }
}
