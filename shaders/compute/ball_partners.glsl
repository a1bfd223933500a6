// Where a body's partners of a phase are: in its list or its items over balls, then in its items over particles.
layout(location = LOCATION_BALL_PHASE) uniform uint ball_phase;
#include "compute/ball_pairs.glsl"
#include "compute/ball_work.glsl"

// Where a body's partners of this phase are.
struct Partners {
  uint listed;   // acting entries of its list: their bits
  uint list;
  uint first_a;  // its items over balls
  uint count_a;
  uint first_b;  // its items over particles
  uint count_b;
};

Partners partners_of(uint body) {
  BallContacts contact = contacts[body];
  uint own_kind = body < ball_count ? KIND_BALL : KIND_PARTICLE;
  Partners of = Partners(0u, 0u, 0u, 0u, 0u, 0u);
  if (phase_has(own_kind, KIND_BALL)) {
    if (contact.listed != CROWDED) {
      of.listed = ball_phase == BALL_PHASE_POSITIONS ? contact.overlapping : contact.acting;
      of.list = contact.list;
    } else {
      of.first_a = contact.list;
      of.count_a = items[contact.list].total;
    }
  }
  if (own_kind == KIND_BALL && ball_phase != BALL_PHASE_BALLS && contact.items != NO_BODY) {
    of.first_b = contact.items;
    of.count_b = items[contact.items].total;
  }
  return of;
}

uint items_in(Partners of) { return of.count_a + of.count_b; }
uint item_at(Partners of, uint k) { return k < of.count_a ? of.first_a + k : of.first_b + (k - of.count_a); }
uint count_in(uint item) {
  return ball_phase == BALL_PHASE_POSITIONS ? items[item].overlapping : items[item].acting;
}
uint word_in(uint item, uint w) {
  return ball_phase == BALL_PHASE_POSITIONS ? items[item].overlaps[w] : items[item].acts[w];
}

// Where in an item with `count` partners, which follow on `before` of the same body, a block begins other than the
// first; `count` if none does.
uint block_start(uint before, uint count) {
  uint skip = (PARTNER_BLOCK - before % PARTNER_BLOCK) % PARTNER_BLOCK;
  return before == 0u || skip >= count ? count : skip;
}
