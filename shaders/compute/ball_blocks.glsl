// Shared by the ball kernels: blocks, slots, and when to do nothing. The method is described in src/physics/balls/balls.h,
// which these kernels follow operation by operation. Explicit methods tell the step by uniforms; under implicit Euler,
// where the host does not know how far the device has got, the Solve block does.
layout(std430, binding = BINDING_STATE_A) restrict buffer StateA { Particle state_a[]; };
layout(std430, binding = BINDING_STATE_B) restrict buffer StateB { Particle state_b[]; };
layout(std430, binding = BINDING_BALLS) restrict buffer Balls { Ball balls[]; };
#ifndef ASPIC_BALL_FACE_KERNEL
layout(std430, binding = BINDING_BALL_CONTACTS) restrict buffer ContactsBlock { BallContacts contacts[]; };
#endif

#ifdef ASPIC_IMPLICIT
layout(std430, binding = BINDING_SOLVE) restrict coherent buffer SolveBlock { Solve solve; };

bool idle() { return solve.phase != PHASE_BALLS || solve.full != 0u || solve.overrun != 0u; }
uint steps_done() { return solve.step; }
uint particle_parity() { return solve.parity; }
uint start_slot() { return solve.parity; }
void mark_divergence(uint bad) { atomicMin(solve.bad_particle, bad); }
void mark_full() { atomicMax(solve.full, 1u); }
void report_overrun(uint kernel) { atomicMax(solve.overrun, kernel); }
void count_item(uint i, uint count) {}  // the phases tell
#else
#include "compute/control.glsl"
layout(location = LOCATION_BALL_PARITY) uniform uint ball_parity;

bool idle() { return halted() || control.full_step == step_index; }
uint particle_parity() { return 0u; }
uint start_slot() { return ball_parity; }
void mark_divergence(uint bad) {
  atomicMin(control.bad_step, step_index);
  atomicMin(control.bad_particle, bad);
}
void mark_full() { atomicMin(control.full_step, step_index); }
#endif
#include "compute/bounded.glsl"

uint end_slot() { return 1u - start_slot(); }

// Where a phase reads balls, and where it writes them.
bool from_end(uint phase) { return phase == BALL_PHASE_PARTICLES || phase == BALL_PHASE_FACES; }
uint slot_before(uint phase) { return from_end(phase) ? end_slot() : BALL_SLOT_BETWEEN; }
uint slot_after(uint phase) { return from_end(phase) ? BALL_SLOT_BETWEEN : end_slot(); }

Ball ball_in(uint slot, uint b) { return balls[slot * ball_count + b]; }

// At the start of the step, and at its end as far as it has come.
Particle start_particle(uint p) {
  if (particle_parity() == 0u) return state_a[p];
  return state_b[p];
}
Particle end_particle(uint p) {
  if (particle_parity() == 0u) return state_b[p];
  return state_a[p];
}
