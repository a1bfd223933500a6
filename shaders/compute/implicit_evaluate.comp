// Implicit Euler: residual (v' − v) − h·a(x + h·v', v') at the trial, and all that a linear system there needs:
// right-hand side, inverse diagonal blocks, first search direction. The last group judges the trial.
// NVIDIA's compiler takes twice as long otherwise. Others ignore it.
#pragma optionNV(unroll none)
#include "compute/layout.glsl"
#include "compute/common.glsl"
#include "compute/implicit.glsl"
#include "compute/incident.glsl"
#include "compute/terms/implicit_springs.glsl"
#include "compute/implicit_block.glsl"
#include "compute/reduction.glsl"
#include "compute/terms/terrain.glsl"
#include "compute/terms/implicit_ground.glsl"
#include "compute/implicit_judge.glsl"

// What the ground makes of particle p with free velocity v at the trial: its reaction, and the residual R,
// right-hand side r and preconditioner of a particle it holds.
Reaction meet_ground(Particle p, vec3 free, vec3 v, inout precise vec3 R, inout precise vec3 r, inout DiagonalBlock b) {
  precise float m = p.velocity.w;
  Reaction reaction = react(p.position.xyz, m, free);
  if (reaction.freedom == FREE_ALL) return reaction;
  R = v - reaction.v;
  r = vec3(0.0);
  if (reaction.freedom != FREE_NONE) r = -(m * free_part(vec4(reaction.axis, reaction.freedom), R));
  if (reaction.freedom == FREE_PLANE) r = r - turning(vec4(reaction.across, reaction.stiffness), R);
  b = with_spring(b, SpringJacobian(reaction.stiffness, 0.0, reaction.across));
  return reaction;
}

// Keeps what the linear system needs of a reaction, and tells the last group of it.
void keep_reaction(uint i, Reaction reaction, vec3 R) {
  set_own4(OWN_GROUND, i, vec4(reaction.axis, reaction.freedom));
  set_own4(OWN_ACROSS, i, vec4(reaction.across, reaction.stiffness));
  precise vec3 prescribed = -R;
  if (reaction.freedom == FREE_ALL) prescribed = vec3(0.0);
  if (reaction.freedom == FREE_PLANE) prescribed = -(dot3(R, reaction.axis) * reaction.axis);
  if (reaction.freedom == FREE_LINE) prescribed = -(R - dot3(R, reaction.axis) * reaction.axis);
  prescribe(i, vec4(prescribed, held_word(reaction)));
  if (reaction.freedom != FREE_ALL) atomicMax(solve.ground, prescribed == vec3(0.0) ? 1u : 2u);
}

// Returns largest |residual| component, its square sum, r·z, and the square sum after a fall.
vec4 evaluate(uint i) {
  Particle p = state(i);
  precise vec3 v = trial[i].xyz;
  precise vec3 f = body_force(p.velocity.w, v);
  DiagonalBlock block = block_of_mass(implicit_mass(p.velocity.w, v));
  Walk w = walk(i);
  for (w.end = bounded(w.end, KERNEL_IMPLICIT_EVALUATE); w.at < w.end; ++w.at) {
    Link link;
    if (!link_at(w, link)) continue;
    precise vec3 dv = v - trial[link.other].xyz;
    precise vec3 e = (p.position.xyz - state(link.other).position.xyz) + time_step * dv;
    SpringJacobian H;
    f += linearized(link.spring, e, dv, H);
    block = with_spring(block, H);
  }
  for (uint k = 0u; k < pull_count; ++k) {
    if (i != pulls[k].particle) continue;
    SpringJacobian H;
    f += linearized(pulls[k], p.position.xyz, v, H);
    block = with_spring(block, H);
  }
#ifdef ASPIC_BODY_CONTACT
  if (solve.in_contact != 0u) {
    precise vec3 diagonal = block.diagonal + contact_of(CONTACT_DIAGONAL, i), mixed = block.mixed + contact_of(CONTACT_MIXED, i);
    block = DiagonalBlock(diagonal, mixed);
  }
#endif
  precise vec3 r = vec3(0.0);
  precise vec3 R = vec3(0.0);
  precise vec3 fall = vec3(0.0);
  Reaction reaction = no_reaction(v);
  if (p.position.w != 0.0) {
    precise vec3 held = own(OWN_HELD, i);
#ifdef ASPIC_BODY_CONTACT
    if (solve.in_contact != 0u) held = held + contact_of(CONTACT_FORCE, i);
#endif
    precise vec3 all_forces = f + held;
    precise vec3 change = v - p.velocity.xyz;
    precise vec3 gained = time_step * (p.position.w * all_forces);
    r = time_step * all_forces - p.velocity.w * change;
    R = change - gained;
    fall = time_step * gravity.xyz;
    precise vec3 free = p.velocity.xyz + gained;
    if (contact_model == CONTACT_COULOMB) reaction = meet_ground(p, free, v, R, r, block);
  }
  keep_reaction(i, reaction, R);
  DiagonalBlock inverted = inverse_of(block);
  precise vec3 z = free_part(vec4(reaction.axis, reaction.freedom), times(inverted, r));
  set_own(OWN_RESIDUAL, i, r);
  set_own(OWN_Z, i, z);
  set_own(OWN_INVERSE_A, i, inverted.diagonal);
  set_own(OWN_INVERSE_B, i, inverted.mixed);
  search[i] = vec4(z, 0.0);
  precise float xy = abs(R.y) > abs(R.x) ? abs(R.y) : abs(R.x);
  precise vec3 after_fall = R + fall;
  return vec4(abs(R.z) > xy ? abs(R.z) : xy, dot3(R, R), dot3(r, z), dot3(after_fall, after_fall));
}

void main() {
  uint phase = enter();
  uint i = item_index();
  bool evaluates = phase == PHASE_EVALUATE || phase == PHASE_CONTACT;
  if (i == 0u && (evaluates || phase == PHASE_CG)) {
    if (solve.moved != solve.ticks * COUNTED_OF(particle_count)) report_overrun(ITEMS_MISSING);
    ++solve.ticks;
  }
  if (i == 0u && phase == PHASE_CG) solve.prescribing = 0u;  // it took the round before
  if (!evaluates) return;
  precise vec4 element = vec4(0.0);
  use_lengths(ended_steps, LENGTHS_AT_END);
  if (i < particle_count) element = evaluate(i);
  precise vec4 total;
  if (reduce(element, total) && gl_LocalInvocationIndex == 0u) judge(total);
}
