// Before balls look for partners: empties the grid's buckets and the marks, and nothing is taken of lists and items.
#include "compute/layout.glsl"
#include "compute/common.glsl"
#include "compute/ball_blocks.glsl"
#include "compute/ball_work.glsl"
#include "compute/ball_grid.glsl"

void main() {
  uint i = item_index();
  if (idle()) return;
  if (i == 0u) reset_work();
  if (i <= bucket_mask) {
    grid[i] = NO_BODY;
  } else if (i - (bucket_mask + 1u) < ball_count * mark_words()) {
    grid[i + ball_count] = 0u;
  }
}
