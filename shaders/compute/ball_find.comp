// The balls that each body touches, balls first, then particles: found by trying all or (ASPIC_BALL_GRID) in the grid, kept
// in ascending index, as a list; who meets more than LIST_SIZE, or looks at more than MAX_WALK, is crowded and gets items
// over all balls.
#include "compute/layout.glsl"
#include "compute/common.glsl"
#include "compute/ball_blocks.glsl"
#include "compute/terms/ball_contact.glsl"
#define ball_phase BALL_PHASE_BALLS
#include "compute/ball_pairs.glsl"
#include "compute/ball_work.glsl"
#include "compute/ball_grid.glsl"

uint found[LIST_SIZE];
uint found_count = 0u;
bool crowded = false;

// Puts a ball into the sorted list if it is near.
void consider(Seeker seeker, uint b) {
  if (!is_partner(seeker, KIND_BALL, b) || !may_contact(seeker, KIND_BALL, b)) return;
  if (!(partner(seeker, KIND_BALL, b).gap.w < contact_distance)) return;
  crowded = found_count == LIST_SIZE;
  if (crowded) return;
  uint at = found_count++;
  for (; at > 0u && found[at - 1u] > b; --at) found[at] = found[at - 1u];
  found[at] = b;
}

#ifdef ASPIC_BALL_GRID
void search(Seeker seeker) {
  // A particle reaches no further than half a cell, a ball no further than a cell.
  bool ball = seeker.kind == KIND_BALL;
  precise vec3 lowest = in_cells(seeker.x) - (ball ? 1.0 : 0.5);
  ivec3 home = ivec3(floor(lowest));
  int span = ball ? 3 : 2;
  int next_cell = 0;
  ivec3 cell = home;
  uint b = NO_BODY;
  // One loop over cells and links, for MAX_WALK to bound both.
  for (uint n = 0u; !crowded; ++n) {
    if (b == NO_BODY) {
      if (next_cell == span * span * span) break;
      cell = home + ivec3(next_cell % span, (next_cell / span) % span, next_cell / (span * span));
      ++next_cell;
      b = grid[head_of(cell)];
    } else {
      // Cells that share a bucket must not be taken for each other.
      if (cell_of(balls[slot_before(ball_phase) * ball_count + b].position.xyz) == cell) consider(seeker, b);
      b = grid[link_of(b)];
    }
    if (n == MAX_WALK) crowded = true;
  }
}
#else
void search(Seeker seeker) {
  for (uint b = 0u; b < ball_count && !crowded; ++b) {
    consider(seeker, b);
    if (b == MAX_WALK) crowded = true;
  }
}
#endif

void keep_list(Seeker seeker, inout BallContacts contact) {
  contact.list = take_list(found_count);
  if (contact.list == NO_BODY) return;
  for (uint n = 0u; n < found_count; ++n) {
    uint b = found[n];
    lists[contact.list + n] = b;
    Partner other = partner(seeker, KIND_BALL, b);
    if (other.gap.w < 0.0) contact.overlapping |= 1u << n;
    if (seeker.kind == KIND_PARTICLE) {
      mark(b, seeker.index);
    } else if (dot3(other.dv, other.gap.xyz) < 0.0) {
      contact.acting |= 1u << n;
    }
  }
  contact.listed = found_count;
  contact.pairs[BALL_PHASE_BALLS] = uint(bitCount(contact.acting));
  contact.pairs[BALL_PHASE_POSITIONS] = uint(bitCount(contact.overlapping));
}

void keep_items(uint body, inout BallContacts contact) {
  uint blocks = blocks_of(ball_count);
  uint count = bounded(blocks, KERNEL_BALL_FIND);
  contact.listed = CROWDED;
  contact.list = take_items(blocks);
  if (contact.list == NO_BODY) return;
  for (uint k = 0u; k < count; ++k) write_item(contact.list + k, body, KIND_BALL, k * PARTNER_BLOCK, blocks);
}

void main() {
  uint i = item_index();
  if (i >= ball_count + particle_count || idle()) return;
  Seeker seeker = seeking(i);
  bool waits = seeker.kind == KIND_BALL && ball_in(slot_before(ball_phase), i).velocity.w == 0.0;
  if (!waits && finite(seeker.x)) search(seeker);
  BallContacts contact = BallContacts(uint[3](0u, 0u, 0u), 0u, 0u, 0u, 0u, NO_BODY);
  if (crowded) {
    keep_items(i, contact);
  } else if (found_count > 0u) {
    keep_list(seeker, contact);
  } else if (seeker.kind == KIND_PARTICLE) {
#ifndef ASPIC_BALL_FACES
    // It is at the end of its step.
    uint bad = divergence_word(seeker.index, seeker.x, seeker.v);
    if (bad != NO_STEP) mark_divergence(bad);
#endif
  }
  contacts[i] = contact;
}
