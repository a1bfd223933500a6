// Implicit Euler: the balls' part of a step is over, unless it has to be repeated.
#include "compute/layout.glsl"
#include "compute/common.glsl"
#include "compute/implicit.glsl"
#include "compute/implicit_end.glsl"

void main() {
  if (solve.phase == PHASE_BALLS && solve.full == 0u && solve.overrun == 0u && item_index() == 0u) end_step();
}
