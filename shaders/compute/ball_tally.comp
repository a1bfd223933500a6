// Which near pairs of a ball and a particle act, once the balls have met each other: first the words of all items, then the
// lists of particles.
#include "compute/layout.glsl"
#include "compute/common.glsl"
#include "compute/ball_blocks.glsl"
#include "compute/terms/ball_contact.glsl"
#define ball_phase BALL_PHASE_PARTICLES
#include "compute/ball_pairs.glsl"
#include "compute/ball_work.glsl"

bool acts(Seeker seeker, uint kind, uint index) {
  Partner other = partner(seeker, kind, index);
  return dot3(other.dv, other.gap.xyz) < 0.0;
}

void tally_word(uint i, uint w) {
  uint body = items[i].body, kind = items[i].kind;
  if (body < ball_count && kind == KIND_BALL) return;
  uint near = items[i].acts[w];
  if (near == 0u) return;
  Seeker seeker = seeking(body);
  uint acting = 0u;
  for (uint left = near; left != 0u; left &= left - 1u) {
    uint n = uint(findLSB(left));
    if (acts(seeker, kind, items[i].first + 32u * w + n)) acting |= 1u << n;
  }
  items[i].acts[w] = acting;
  if (acting == 0u) return;
  uint count = uint(bitCount(acting));
  atomicAdd(items[i].acting, count);
  atomicAdd(contacts[body].pairs[BALL_PHASE_PARTICLES], count);
}

void tally_list(uint p) {
  BallContacts contact = contacts[ball_count + p];
  if (contact.listed == 0u || contact.listed == CROWDED) return;
  Seeker seeker = seeking_particle(p);
  uint acting = 0u;
  for (uint n = 0u; n < contact.listed; ++n) {
    uint b = lists[contact.list + n];
    if (acts(seeker, KIND_BALL, b)) acting |= 1u << n;
  }
  contacts[ball_count + p].acting = acting;
  contacts[ball_count + p].pairs[BALL_PHASE_PARTICLES] = uint(bitCount(acting));
}

void main() {
  if (idle()) return;
  uint i = item_index(), words = ITEM_WORDS * work.items_used;
  if (i < words) {
    tally_word(i / ITEM_WORDS, i % ITEM_WORDS);
  } else if (i - words < particle_count) {
    tally_list(i - words);
  }
}
