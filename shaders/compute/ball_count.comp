// How many pairs each body has in this phase: c of spec §2.7. Balls first, then particles.
#include "compute/layout.glsl"
#include "compute/common.glsl"
#include "compute/ball_blocks.glsl"
#include "compute/ball_contact.glsl"
layout(location = LOCATION_BALL_PHASE) uniform uint ball_phase;
#include "compute/ball_search.glsl"

uint pairs_of(Seeker own, uint kind) {
  uint count = 0u;
  uint from = 0u;
  do {
    find(own, kind, from);
    count += found_count;
    from = next_after_list();
  } while (from != NO_BODY);
  return count;
}

void main() {
  uint i = item_index();
  if (i >= ball_count + particle_count || idle()) return;
  uint count = 0u;
  if (i < ball_count) {
    Seeker own = seeking_ball(i);
    if (ball_in(slot_before(ball_phase), i).velocity.w != 0.0) {
      if (phase_has(KIND_BALL)) count += pairs_of(own, KIND_BALL);
      if (phase_has(KIND_PARTICLE)) count += pairs_of(own, KIND_PARTICLE);
    }
  } else if (phase_has(KIND_PARTICLE)) {
    count = pairs_of(seeking_particle(i - ball_count), KIND_BALL);
  }
  acting[i] = count;
}
