// Implicit Euler on the device: a small state machine in the Solve block decides what each dispatch does, so that any
// number of rounds can be queued and none needs a read-back. A round is evaluate, apply, update, direction; a step is
// begin, as many rounds as it takes, finish. Kernels whose phase it is not return at once.
// The method and its source stand in src/cpu_reference/implicit_euler.h, which this follows operation by operation.
layout(std430, binding = BINDING_STATE_A) restrict buffer StateA { Particle state_a[]; };
layout(std430, binding = BINDING_STATE_B) restrict buffer StateB { Particle state_b[]; };
layout(std430, binding = BINDING_TRIAL) restrict buffer Trial { vec4 trial[]; };
layout(std430, binding = BINDING_SEARCH) restrict buffer Search { vec4 search[]; };
layout(std430, binding = BINDING_SOLVE) restrict coherent buffer SolveBlock {
  Solve solve;
  vec4 partials[];
};
layout(std430, binding = BINDING_OWN) restrict buffer Own { vec4 own_vectors[]; };

Particle state(uint i) {
  if (solve.parity == 0u) return state_a[i];
  return state_b[i];
}

vec3 own(uint which, uint i) { return own_vectors[which * particle_count + i].xyz; }
void set_own(uint which, uint i, vec3 value) { own_vectors[which * particle_count + i] = vec4(value, 0.0); }

void report_overrun(uint kernel) { atomicMax(solve.overrun, kernel); }
#include "compute/bounded.glsl"
