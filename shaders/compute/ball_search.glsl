// Who touches a body: a ball's balls, a ball's particles, a particle's balls. Partners come in ascending index, a list at
// a time, so that sums run in that order however they were found: by trying all, or (ASPIC_BALL_GRID) by a uniform
// grid of cells no smaller than the reach, hashed into buckets. The order inside a bucket is left to chance; each
// list keeps the smallest indices, sorted. Expects ball_phase.
#define KIND_BALL 0u
#define KIND_PARTICLE 1u
#define LIST_SIZE 32u

// A body as it looks for partners. start: velocity at the start of the step; radius: 0 for a particle.
struct Seeker {
  vec3 x;
  vec3 v;
  vec3 start;
  float radius;
  uint kind;
  uint index;
};

// A partner as the seeker sees it. gap: normal towards the seeker, distance; dv, dv_0: the seeker's velocity less its.
struct Partner {
  vec4 gap;
  vec3 dv;
  vec3 dv_0;
};

// Balls that wait and the body itself are no partners.
bool is_body(Seeker own, uint kind, uint index) {
  if (kind == KIND_PARTICLE) return true;
  if (own.kind == KIND_BALL && own.index == index) return false;
  return ball_in(slot_before(ball_phase), index).velocity.w != 0.0;
}

vec3 position_of(uint kind, uint index) {
  if (kind == KIND_PARTICLE) return end_particle(index).position.xyz;
  return ball_in(slot_before(ball_phase), index).position.xyz;
}

Partner partner(Seeker own, uint kind, uint index) {
  if (kind == KIND_PARTICLE) {
    Particle p = end_particle(index);
    precise vec3 e = own.x - p.position.xyz, dv = own.v - p.velocity.xyz;
    precise vec3 dv_0 = own.start - start_particle(index).velocity.xyz;
    return Partner(pair_gap(e, own.radius, false), dv, dv_0);
  }
  Ball b = ball_in(slot_before(ball_phase), index);
  precise vec3 e = own.x - b.position.xyz, dv = own.v - b.velocity.xyz;
  precise vec3 dv_0 = own.start - b.start_velocity.xyz;
  precise float reach = b.position.w;
  if (own.kind == KIND_BALL) reach = own.radius + reach;
  return Partner(pair_gap(e, reach, own.kind == KIND_PARTICLE || own.index < index), dv, dv_0);
}

// Whether the pair takes part in this phase.
bool takes_part(Seeker own, uint kind, uint index) {
  if (!is_body(own, kind, index)) return false;
  Partner other = partner(own, kind, index);
  if (ball_phase == BALL_PHASE_POSITIONS) return other.gap.w < 0.0;
  return other.gap.w < epsilon && dot3(other.dv, other.gap.xyz) < 0.0;
}

uint found[LIST_SIZE];
uint found_count = 0u;
uint bodies_of(uint kind) { return kind == KIND_BALL ? ball_count : particle_count; }

#ifdef ASPIC_BALL_GRID
#include "compute/ball_grid.glsl"

// Puts an index into the sorted list; a full list loses its largest.
void keep(uint index) {
  uint at = found_count;
  if (found_count < LIST_SIZE) {
    ++found_count;
  } else if (index > found[LIST_SIZE - 1u]) {
    return;
  } else {
    at = LIST_SIZE - 1u;
  }
  for (; at > 0u && found[at - 1u] > index; --at) found[at] = found[at - 1u];
  found[at] = index;
}

void find(Seeker own, uint kind, uint from) {
  found_count = 0u;
  if (!finite(own.x)) return;
  ivec3 home = cell_of(kind, own.x);
  for (int c = 0; c < 27; ++c) {
    ivec3 cell = home + ivec3(c % 3 - 1, (c / 3) % 3 - 1, c / 9 - 1);
    for (uint index = grid[head_of(kind, cell)]; index != NO_BODY; index = grid[link_of(kind, index)]) {
      // Cells that share a bucket must not be taken for each other.
      if (index >= from && cell_of(kind, position_of(kind, index)) == cell && takes_part(own, kind, index)) keep(index);
    }
  }
}
#else
void find(Seeker own, uint kind, uint from) {
  found_count = 0u;
  for (uint index = from; index < bodies_of(kind) && found_count < LIST_SIZE; ++index) {
    if (takes_part(own, kind, index)) found[found_count++] = index;
  }
}
#endif

// First index not yet looked at after a list; past every index when it was the last.
uint next_after_list() { return found_count == LIST_SIZE ? found[LIST_SIZE - 1u] + 1u : NO_BODY; }

Seeker seeking_ball(uint b) {
  Ball ball = ball_in(slot_before(ball_phase), b);
  return Seeker(ball.position.xyz, ball.velocity.xyz, ball.start_velocity.xyz, ball.position.w, KIND_BALL, b);
}

Seeker seeking_particle(uint p) {
  Particle particle = end_particle(p);
  return Seeker(particle.position.xyz, particle.velocity.xyz, start_particle(p).velocity.xyz, 0.0, KIND_PARTICLE, p);
}

// Whether this phase has pairs of a ball with that kind.
bool phase_has(uint kind) {
  if (ball_phase == BALL_PHASE_POSITIONS) return true;
  return (ball_phase == BALL_PHASE_BALLS) == (kind == KIND_BALL);
}
