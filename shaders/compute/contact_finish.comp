// The rest of a stage of particles whose forces are complete but for the ground's (ASPIC_BODY_CONTACT in compute/stage.glsl).
#define ASPIC_BODY_CONTACT_FINISH
#include "compute/layout.glsl"
#include "compute/common.glsl"
#include "compute/control.glsl"
#include "compute/stage.glsl"

void main() {
  uint i = item_index();
  if (i >= particle_count || halted()) return;
  Particle p = stage_state[i];
  end_stage(i, p, out_state[i].velocity.xyz);
}
