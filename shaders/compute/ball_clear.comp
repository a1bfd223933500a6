// Empties the grid's buckets.
#include "compute/layout.glsl"
#include "compute/common.glsl"
#include "compute/ball_blocks.glsl"
#include "compute/ball_grid.glsl"

void main() {
  uint i = item_index();
  if (i < 2u * (bucket_mask + 1u) && !idle()) grid[i] = NO_BODY;
}
