// Puts balls, then particles, into the grid, where they stand after flight and terrain; nobody moves again before the
// position phase has been computed. What is not finite touches nobody.
#include "compute/layout.glsl"
#include "compute/common.glsl"
#include "compute/ball_blocks.glsl"
#include "compute/ball_grid.glsl"

void insert(uint kind, uint index, vec3 x) {
  if (finite(x)) grid[link_of(kind, index)] = atomicExchange(grid[head_of(kind, cell_of(kind, x))], index);
}

void main() {
  uint i = item_index();
  if (i >= ball_count + particle_count || idle()) return;
  if (i < ball_count) {
    Ball ball = ball_in(BALL_SLOT_BETWEEN, i);
    if (ball.velocity.w != 0.0) insert(0u, i, ball.position.xyz);
  } else {
    insert(1u, i - ball_count, end_particle(i - ball_count).position.xyz);
  }
}
