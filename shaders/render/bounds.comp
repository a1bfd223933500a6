// The box of all particles in each light's space: shadow maps are fitted to it without the processor's help.
#include "render/layout.glsl"
#include "render/bounds.glsl"
#include "compute/dispatch.glsl"

layout(std430, binding = BINDING_PARTICLES) restrict readonly buffer Particles { Particle particles[]; };

shared uvec3 group_lower[LIGHTS];
shared uvec3 group_upper[LIGHTS];

void main() {
  uint i = item_index();
  if (gl_LocalInvocationIndex < uint(LIGHTS)) {
    group_lower[gl_LocalInvocationIndex] = uvec3(0xffffffffu);
    group_upper[gl_LocalInvocationIndex] = uvec3(0u);
  }
  barrier();
  // Each invocation takes many particles: atomics are dear.
  uint stride = gl_NumWorkGroups.x * gl_WorkGroupSize.x;
  for (int light = 0; light < LIGHTS; ++light) {
    uvec3 lower = uvec3(0xffffffffu), upper = uvec3(0u);
    for (uint particle = i; particle < particle_count; particle += stride) {
      vec3 p = mat3(lights[light]) * particles[particle].position.xyz;
      lower = min(lower, ordered(p));
      upper = max(upper, ordered(p));
    }
    atomicMin(group_lower[light].x, lower.x);
    atomicMin(group_lower[light].y, lower.y);
    atomicMin(group_lower[light].z, lower.z);
    atomicMax(group_upper[light].x, upper.x);
    atomicMax(group_upper[light].y, upper.y);
    atomicMax(group_upper[light].z, upper.z);
  }
  barrier();
  if (gl_LocalInvocationIndex < uint(LIGHTS)) {
    int light = int(gl_LocalInvocationIndex);
    widen(light, group_lower[light], group_upper[light]);
  }
}
