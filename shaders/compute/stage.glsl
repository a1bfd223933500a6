// What follows the springs, the same for every force path: pulls, contact force or the ground's reaction, acceleration,
// the stage of the explicit method (src/model/integrator.h has the formulas), and after the last stage the terrain's
// response and the watch for divergence. Expects the state blocks below to be bound. With ASPIC_ONE_STAGE the method has
// one stage, which begins where the step does and leaves no sums.
#include "compute/terms/pulls.glsl"
#include "compute/terms/terrain.glsl"

layout(std430, binding = BINDING_START_STATE) restrict readonly buffer StartState { Particle start_state[]; };
layout(std430, binding = BINDING_STAGE_STATE) restrict readonly buffer StageState { Particle stage_state[]; };
// With ASPIC_BODY_CONTACT contact between bodies comes between pulls and ground: the kernel of forces leaves them in the place of
// the next velocity, from where contact_finish.comp, with ASPIC_BODY_CONTACT_FINISH, goes on.
#ifdef ASPIC_BODY_CONTACT_FINISH
layout(std430, binding = BINDING_OUT_STATE) restrict buffer OutState { Particle out_state[]; };
#else
layout(std430, binding = BINDING_OUT_STATE) restrict writeonly buffer OutState { Particle out_state[]; };
#endif
layout(std430, binding = BINDING_STAGE_SUMS) restrict buffer StageSums { Particle stage_sums[]; };

void finish_step(uint i, Particle start, vec3 slope_x, vec3 slope_v) {
  precise vec3 v = start.velocity.xyz + step_scale * slope_v;
  precise vec3 x = start.position.xyz + step_scale * (drift == DRIFT_NEW_VELOCITY ? v : slope_x);
  respond(start, x, v);
  // With balls in the scene the step is not at its end yet: the last of their kernels looks.
  uint bad = ball_count == 0u ? divergence_word(i, x, v) : NO_STEP;
  if (bad != NO_STEP) {
    atomicMin(control.bad_step, step_index);
    atomicMin(control.bad_particle, bad);
  }
  out_state[i] = Particle(vec4(x, start.position.w), vec4(v, start.velocity.w));
}

// p: the particle in this stage; f_in: all forces but the ground's [N].
void end_stage(uint i, Particle p, vec3 f_in) {
  precise vec3 f = f_in;
#ifdef ASPIC_ONE_STAGE
  Particle start = p;
#else
  Particle start = start_state[i];
#endif
  if (p.position.w != 0.0) {
    if (contact_model == CONTACT_COURSE) {
      f = with_contact_force(p.position.xyz, p.velocity.xyz, f);
    } else {
      f = with_ground_reaction(start, f);
    }
  }
  precise vec3 a = p.position.w * f;

  Stage stage = stages[stage_index];
  precise vec3 slope_x = stage.weight * p.velocity.xyz;
  precise vec3 slope_v = stage.weight * a;
#ifdef ASPIC_ONE_STAGE
  finish_step(i, start, slope_x, slope_v);
#else
  if (stage.accumulate != 0u) {
    slope_x = stage_sums[i].position.xyz + slope_x;
    slope_v = stage_sums[i].velocity.xyz + slope_v;
  }
  if (stage.last != 0u) {
    finish_step(i, start, slope_x, slope_v);
    return;
  }
  if (stage.weight != 0.0) stage_sums[i] = Particle(vec4(slope_x, 0.0), vec4(slope_v, 0.0));
  precise vec3 next_v = start.velocity.xyz + stage.advance * a;
  precise vec3 moves = drift == DRIFT_MEAN_VELOCITY ? 0.5 * (p.velocity.xyz + next_v) : p.velocity.xyz;
  precise vec3 next_x = start.position.xyz + stage.advance * moves;
  out_state[i] = Particle(vec4(next_x, start.position.w), vec4(next_v, start.velocity.w));
#endif
}

// f_springs: gravity and springs [N].
void finish_stage(uint i, Particle p, vec3 f_springs) {
  count_item(i, particle_count);
  precise vec3 f = with_pulls(i, p.position.xyz, p.velocity.xyz, f_springs);
#ifdef ASPIC_BODY_CONTACT
  out_state[i] = Particle(p.position, vec4(f, p.velocity.w));
#else
  end_stage(i, p, f);
#endif
}
