// Implicit Euler on the device: a small state machine in the Solve block decides what each dispatch does, so that any
// number of rounds can be queued and none needs a read-back. A round is evaluate, apply, update, direction, with kernels of
// contact between bodies around them where these may touch (implicit_contact_*.comp); a step is begin, as many rounds as it
// takes, finish. Kernels whose phase it is not return at once. Where the ground prescribes a
// part of δ, a linear system begins with a round that takes A times it to the right-hand side (Solve.prescribing).
// src/cpu_reference/implicit_euler.h has the method and its source; this follows it operation by operation.
#include "compute/implicit_control.glsl"
#include "compute/implicit_state.glsl"

layout(std430, binding = BINDING_TRIAL) restrict buffer Trial { vec4 trial[]; };
layout(std430, binding = BINDING_SEARCH) restrict buffer Search { vec4 search[]; };
layout(std430, binding = BINDING_OWN) restrict buffer Own { vec4 own_vectors[]; };

uint own_at(uint which, uint i) { return which * particle_count + i; }

vec3 own(uint which, uint i) { return own_vectors[own_at(which, i)].xyz; }
vec4 own4(uint which, uint i) { return own_vectors[own_at(which, i)]; }
void set_own(uint which, uint i, vec3 value) { own_vectors[own_at(which, i)] = vec4(value, 0.0); }
void set_own4(uint which, uint i, vec4 value) { own_vectors[own_at(which, i)] = value; }

// The part of δ that the ground prescribes.
void prescribe(uint i, vec4 value) {
  set_own4(OWN_PRESCRIBED, i, value);
#ifdef ASPIC_BODY_CONTACT
  search[CONTACT_AT(CONTACT_PRESCRIBED, i)] = value;
#endif
}

// The part of y that the ground leaves free; ground: OWN_GROUND of the particle.
vec3 free_part(vec4 ground, vec3 y) {
  precise vec3 part = y;
  if (ground.w == FREE_PLANE) part = y - dot3(y, ground.xyz) * ground.xyz;
  if (ground.w == FREE_LINE) part = dot3(y, ground.xyz) * ground.xyz;
  if (ground.w == FREE_NONE) part = vec3(0.0);
  return part;
}

// Friction's part of the matrix times p; across: OWN_ACROSS of a particle that the ground leaves a plane.
vec3 turning(vec4 across, vec3 p) {
  precise vec3 product = (across.w * dot3(across.xyz, p)) * across.xyz;
  return product;
}

#ifdef ASPIC_BODY_CONTACT
#include "compute/implicit_contact.glsl"
#endif
#include "compute/bounded.glsl"
