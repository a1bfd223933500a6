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
      atomicMin(group_lower[light].x, ordered(p.x));
      atomicMin(group_lower[light].y, ordered(p.y));
      atomicMin(group_lower[light].z, ordered(p.z));
      atomicMax(group_upper[light].x, ordered(p.x));
      atomicMax(group_upper[light].y, ordered(p.y));
      atomicMax(group_upper[light].z, ordered(p.z));
    }
  }
  barrier();
  if (gl_LocalInvocationIndex < uint(LIGHTS)) {
    int light = int(gl_LocalInvocationIndex);
    atomicMin(bounds[light].lower.x, group_lower[light].x);
    atomicMin(bounds[light].lower.y, group_lower[light].y);
    atomicMin(bounds[light].lower.z, group_lower[light].z);
    atomicMax(bounds[light].upper.x, group_upper[light].x);
    atomicMax(bounds[light].upper.y, group_upper[light].y);
    atomicMax(bounds[light].upper.z, group_upper[light].z);
  }
}
