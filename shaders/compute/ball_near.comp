// Which candidates of the items of one kind are near: a word of 32 an invocation. Of two balls it also says whether they
// act, since their velocities are those of this moment.
#include "compute/layout.glsl"
#include "compute/common.glsl"
#include "compute/ball_blocks.glsl"
#include "compute/terms/ball_contact.glsl"
layout(location = LOCATION_BALL_KIND) uniform uint sought;
#define ball_phase BALL_PHASE_BALLS
#include "compute/ball_pairs.glsl"
#include "compute/ball_work.glsl"
#include "compute/ball_grid.glsl"

void main() {
  uint i = item_index() / ITEM_WORDS, w = item_index() % ITEM_WORDS;
  if (idle() || i >= work.items_used || items[i].kind != sought) return;
  uint body = items[i].body;
  Seeker seeker = seeking(body);
  bool velocities_known = seeker.kind == KIND_BALL && sought == KIND_BALL;
  uint end = sought == KIND_BALL ? ball_count : particle_count;
  uint first = items[i].first + 32u * w;
  uint acts = 0u, overlaps = 0u;
  for (uint n = 0u; n < 32u && first + n < end; ++n) {
    uint index = first + n;
    if (!is_partner(seeker, sought, index) || !may_contact(seeker, sought, index)) continue;
    Partner other = partner(seeker, sought, index);
    if (!(other.gap.w < contact_distance)) continue;
    if (!velocities_known || dot3(other.dv, other.gap.xyz) < 0.0) acts |= 1u << n;
    if (other.gap.w < 0.0) overlaps |= 1u << n;
    if (seeker.kind == KIND_PARTICLE) mark(index, seeker.index);
  }
  items[i].acts[w] = acts;
  items[i].overlaps[w] = overlaps;
  if (overlaps != 0u) {
    uint count = uint(bitCount(overlaps));
    atomicAdd(items[i].overlapping, count);
    atomicAdd(contacts[body].pairs[BALL_PHASE_POSITIONS], count);
  }
  if (velocities_known && acts != 0u) {
    uint count = uint(bitCount(acts));
    atomicAdd(items[i].acting, count);
    atomicAdd(contacts[body].pairs[BALL_PHASE_BALLS], count);
  }
}
