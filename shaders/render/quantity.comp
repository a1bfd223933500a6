// What colours show of each particle: its speed, the mean strain of its springs, or the net force they exert on it.
#define ASPIC_LATTICES  // a model without any has none in the table
#define ASPIC_LISTED
#include "render/layout.glsl"
#include "compute/dispatch.glsl"

layout(std430, binding = BINDING_PARTICLES) restrict readonly buffer Particles { Particle particles[]; };
layout(std430, binding = BINDING_SPRING_CLASSES) restrict readonly buffer Classes { SpringClass spring_classes[]; };
layout(std430, binding = BINDING_QUANTITY) restrict writeonly buffer Quantity { float quantity[]; };
layout(location = LOCATION_CLASS_BITS) uniform uint class_bits;

#include "compute/incident.glsl"

void main() {
  uint i = item_index();
  if (i >= particle_count) return;
  Particle p = particles[i];
  if (colour_mode == COLOUR_SPEED) {
    quantity[i] = length(p.velocity.xyz);
    return;
  }
  vec3 force = vec3(0.0);
  float strain = 0.0;
  uint springs = 0u;
  // The host has looked at how many there are.
  for (Walk w = walk(i); w.at < w.end; ++w.at) {
    Link link;
    if (!link_at(w, link)) continue;
    ++springs;
    Particle other = particles[link.other];
    vec3 e = p.position.xyz - other.position.xyz;
    float L = length(e);
    float stretch = L - link.spring.rest_length;
    strain += abs(stretch) / link.spring.rest_length;
    if (L == 0.0 || (link.spring.cord != 0u && L < link.spring.rest_length)) continue;
    float s = link.spring.stiffness * stretch + link.spring.damping * dot(p.velocity.xyz - other.velocity.xyz, e) / L;
    force -= (s / L) * e;
  }
  quantity[i] = colour_mode == COLOUR_FORCE ? length(force) : strain / float(max(springs, 1u));
}
