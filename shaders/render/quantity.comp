// What colours show of each particle: its speed, the mean strain of its springs, or the net force they exert on it.
#include "render/layout.glsl"
#include "render/particle.glsl"
#include "compute/dispatch.glsl"

layout(std430, binding = BINDING_PARTICLES) restrict readonly buffer Particles { Particle particles[]; };
layout(std430, binding = BINDING_SPRING_START) restrict readonly buffer SpringStart { uint spring_start[]; };
layout(std430, binding = BINDING_SPRING_ENDS) restrict readonly buffer SpringEnds { uvec2 spring_ends[]; };
layout(std430, binding = BINDING_SPRING_CLASSES) restrict readonly buffer SpringClasses { vec4 spring_classes[]; };
layout(std430, binding = BINDING_QUANTITY) restrict writeonly buffer Quantity { float quantity[]; };

void main() {
  uint i = item_index();
  if (i >= particle_count) return;
  Particle p = particles[i];
  if (colour_mode == COLOUR_SPEED) {
    quantity[i] = length(p.velocity.xyz);
    return;
  }
  uint first = spring_start[i];
  uint end = spring_start[i + 1u];
  vec3 force = vec3(0.0);
  float strain = 0.0;
  for (uint n = first; n < end; ++n) {
    Particle other = particles[spring_ends[n].x];
    vec4 spring = spring_classes[spring_ends[n].y];  // k, c, r, cord
    vec3 e = p.position.xyz - other.position.xyz;
    float L = length(e);
    strain += abs(L - spring.z) / spring.z;
    if (L == 0.0 || (spring.w > 0.0 && L < spring.z)) continue;
    float s = spring.x * (L - spring.z) + spring.y * dot(p.velocity.xyz - other.velocity.xyz, e) / L;
    force -= (s / L) * e;
  }
  quantity[i] = colour_mode == COLOUR_FORCE ? length(force) : strain / float(max(end - first, 1u));
}
