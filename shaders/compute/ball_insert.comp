// Puts balls into the grid where they are after flight and terrain; nobody moves again before the position phase has been
// computed. Bodies that are not finite touch nobody.
#include "compute/layout.glsl"
#include "compute/common.glsl"
#include "compute/ball_blocks.glsl"
#include "compute/ball_grid.glsl"

void main() {
  uint b = item_index();
  if (b >= ball_count || idle()) return;
  Ball ball = ball_in(BALL_SLOT_BETWEEN, b);
  if (ball.velocity.w == 0.0 || !finite(ball.position.xyz)) return;
  grid[link_of(b)] = atomicExchange(grid[head_of(cell_of(ball.position.xyz))], b);
}
