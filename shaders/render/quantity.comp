// The quantity of each particle that colors show: its speed, the mean strain of its springs, the net force they exert on it, or its
// half of their energy; and the extremes of it over bodies and balls, and over springs.
#define ASPIC_LATTICES  // a model without any has none in the table
#define ASPIC_LISTED
#include "render/layout.glsl"
#include "render/ordered.glsl"
#include "render/spring_quantity.glsl"
#include "compute/dispatch.glsl"

layout(std430, binding = BINDING_PARTICLES) restrict readonly buffer Particles { Particle particles[]; };
layout(std430, binding = BINDING_BALLS) restrict readonly buffer Balls { Ball balls[]; };
layout(std430, binding = BINDING_SPRING_CLASSES) restrict readonly buffer Classes { SpringClass spring_classes[]; };
layout(std430, binding = BINDING_QUANTITY) restrict writeonly buffer Quantity { float quantity[]; };
layout(std430, binding = BINDING_EXTREMES) restrict buffer Extremes { uint extremes[EXTREMES]; };
layout(location = LOCATION_COUNT) uniform uint ball_count;
layout(location = LOCATION_FIRST) uniform uint first_ball;
layout(location = LOCATION_CLASS_BITS) uniform uint class_bits;

#include "compute/incident.glsl"

// Makes the extremes from this place on hold these values too. Atomics are dear: most values lie within.
void widen(int place, float low, float high) {
  if (ordered(low) < extremes[place]) atomicMin(extremes[place], ordered(low));
  if (ordered(high) > extremes[place + 1]) atomicMax(extremes[place + 1], ordered(high));
}

void show(uint i, float value) {
  quantity[i] = value;
  widen(EXTREMES_BODIES, value, value);
}

void main() {
  uint i = item_index();
  if (color_mode == COLOR_SPEED && i < ball_count && balls[first_ball + i].velocity.w != 0.0) {
    float speed = length(balls[first_ball + i].velocity.xyz);
    widen(EXTREMES_BODIES, speed, speed);
  }
  if (i >= particle_count) return;
  Particle p = particles[i];
  if (color_mode == COLOR_SPEED) {
    show(i, length(p.velocity.xyz));
    return;
  }
  vec3 force = vec3(0.0);
  float sum = 0.0, low = 0.0, high = 0.0;
  uint springs = 0u;
  // The host has looked at how many there are.
  for (Walk w = walk(i); w.at < w.end; ++w.at) {
    Link link;
    if (!link_at(w, link)) continue;
    Particle other = particles[link.other];
    vec3 e = p.position.xyz - other.position.xyz;
    SpringQuantity q = spring_quantity(e, p.velocity.xyz - other.velocity.xyz, link.spring.stiffness, link.spring.damping,
                                       link.spring.rest_length, link.spring.cord != 0u);
    float value = chosen_of(q);
    low = springs == 0u ? value : min(low, value);
    high = springs == 0u ? value : max(high, value);
    sum += value;
    ++springs;
    if (q.strength != 0.0) force -= (q.strength / length(e)) * e;
  }
  if (springs > 0u) widen(EXTREMES_SPRINGS, low, high);
  float mean = sum / float(max(springs, 1u));
  show(i, color_mode == COLOR_FORCE ? length(force) : color_mode == COLOR_ENERGY ? 0.5 * sum : mean);
}
