// Items of each ball over the blocks of particles that its marks name, in ascending order.
#include "compute/layout.glsl"
#include "compute/common.glsl"
#include "compute/ball_blocks.glsl"
#include "compute/terms/ball_contact.glsl"
#define ball_phase BALL_PHASE_PARTICLES
#include "compute/ball_pairs.glsl"
#include "compute/ball_work.glsl"
#include "compute/ball_grid.glsl"

void main() {
  uint b = item_index();
  if (b >= ball_count || idle()) return;
  uint words = bounded(mark_words(), KERNEL_BALL_GATHER);
  uint row = marks_of(b);
  uint marked = 0u;
  for (uint w = 0u; w < words; ++w) marked += uint(bitCount(grid[row + w]));
  if (marked == 0u) return;
  uint total = marked << mark_shift;
  uint first = take_items(total);
  contacts[b].items = first;
  if (first == NO_BODY) return;
  // One loop over words, marks and the blocks of each mark.
  uint taken = 0u, w = 0u, part = 0u;
  uint left = grid[row];
  uint rounds = bounded(words + total, KERNEL_BALL_GATHER);
  for (uint n = 0u; n < rounds && taken < total; ++n) {
    if (left == 0u) {
      left = grid[row + ++w];
      continue;
    }
    uint block = ((32u * w + uint(findLSB(left))) << mark_shift) + part;
    write_item(first + taken, b, KIND_PARTICLE, block * PARTNER_BLOCK, total);
    ++taken;
    if (++part == 1u << mark_shift) {
      part = 0u;
      left &= left - 1u;
    }
  }
}
