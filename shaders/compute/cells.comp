// Force path `lattice`, bodies of cells: as lattice.comp, but an invocation's run is one of a block's places or all four,
// neighbors are found with the map of blocks, and springs in the patterns that a block's record names
// (src/model/cell_blocks.h). With ASPIC_MIXED the blocks whose springs are of several sets of classes, else all others.
// Neighbors come in ascending index: of the six two steps away each is followed by the rows up to the next. They are a
// loop, since Mesa compiled them for 20 s one by one, with classes that are read from memory.
#include "compute/layout.glsl"
#include "compute/common.glsl"
#include "compute/control.glsl"
#include "compute/terms/link_force.glsl"
#include "compute/stage.glsl"
#include "compute/spring_classes.glsl"
#include "compute/cells.glsl"
#include "compute/neighbor.glsl"

Particle own[ASPIC_LATTICE_RUN];
Pattern patterns[ASPIC_LATTICE_RUN];
Row rows[ASPIC_LATTICE_RUN];  // of the row at hand
precise vec3 force[ASPIC_LATTICE_RUN];
precise vec3 other_x, other_v;

#define TAKE(p)                                                           \
  own[p] = stage_state[particle_at(body, own_block, first_place + (p))]; \
  patterns[p] = pattern_of(body, record, uint(first_place + (p)));        \
  force[p] = body_force(own[p].velocity.w, own[p].velocity.xyz);
#define MOVE_DOWN(p)    \
  own[p] = own[p + 1];  \
  force[p] = force[p + 1];
// What lies t steps from the run's first place, in the row at hand.
#define SEE(t) read_neighbor(particle_at(body, row_block, first_place + (t)), other_x, other_v);
// Its force on particle p of the run; `plain` is the spring's class where it follows from the direction.
#define LINK(p, links, n, plain)                                                                               \
  {                                                                                                            \
    SpringClass spring;                                                                                        \
    bool joined = find_spring(body, links, n, plain, spring);                                                  \
    precise vec3 sum =                                                                                         \
        force[p] + link_force(spring, own[p].position.xyz, own[p].velocity.xyz, other_x, other_v).xyz;         \
    if (joined) force[p] = sum;                                                                                \
  }
#define BACK(p) LINK(p, rows[p], 0u, slanted)
#define STRAIGHT(p) LINK(p, rows[p], 1u, straight)
#define FORTH(p) LINK(p, rows[p], 2u, slanted)
#define OVER(p) SEE(p + over) LINK(p, ends_of(patterns[p], s, d), 0u, classes[3])
#define ROW_OF(p) rows[p] = row_of(patterns[p], r, d);

#if ASPIC_LATTICE_RUN == 1
#define EACH_OF_RUN(f) f(0)
#define EACH_BUT_THE_LAST(f)
#define EACH_OF_ROW SEE(-1) BACK(0) SEE(0) STRAIGHT(0) SEE(1) FORTH(0)
#elif ASPIC_LATTICE_RUN == 4
#define EACH_OF_RUN(f) f(0) f(1) f(2) f(3)
#define EACH_BUT_THE_LAST(f) f(0) f(1) f(2)
#define EACH_OF_ROW                                   \
  SEE(-1) BACK(0)                                     \
  SEE(0) STRAIGHT(0) BACK(1)                          \
  SEE(1) FORTH(0) STRAIGHT(1) BACK(2)                 \
  SEE(2) FORTH(1) STRAIGHT(2) BACK(3)                 \
  SEE(3) FORTH(2) STRAIGHT(3)                         \
  SEE(4) FORTH(3)
#endif

void main() {
  uint first = item_index() * uint(ASPIC_LATTICE_RUN);  // of the places of all records
  if (item_index() >= RECORDS * BLOCK_PLACES / uint(ASPIC_LATTICE_RUN) || halted()) return;
  use_lengths(step_index, stage_index);
  uint record = RECORD(first / BLOCK_PLACES);
  int first_place = int(first % BLOCK_PLACES);
  CellBody body = cell_bodies[cell_words[record] >> BLOCK_BITS];
  int at = int(body.first_block + (cell_words[record] & ((1u << BLOCK_BITS) - 1u)));
  int plane = int(body.plane_blocks), line = int(body.row_blocks);
  uint own_block = cell_words[at];
  EACH_OF_RUN(TAKE)
  SpringClass classes[LATTICE_CLASSES];
  for (uint c = 0u; c < LATTICE_CLASSES; ++c) classes[c] = spring_class(first_class(body, patterns[0]) + c);
  uint d = 0u, r = 0u;  // direction, and row, of the next neighbor
  for (uint s = 0u; s < 6u; ++s) {
    // Two steps along −x, −y, −z, z, y and x.
    int steps = s < 3u ? -2 : 2;
    uint axis = s < 3u ? s : 5u - s;
    int over = axis == 2u ? steps : 0;
    uint row_block = block_at(body, at + (axis == 0u ? steps * plane : axis == 1u ? steps * line : 0));
    EACH_OF_RUN(OVER)
    ++d;
    // Up to the next of these three, one, one, one, three rows and none.
    for (uint end = s == 0u ? 3u : s < 4u ? s + 3u : 9u; r < end; ++r) {
      int di = int(r / 3u) - 1, dj = int(r % 3u) - 1;
      uint m = uint(di * di + dj * dj);  // 0: the own row
      row_block = block_at(body, at + di * plane + dj * line);
      SpringClass straight = classes[0], slanted = classes[0];
      if (m == 2u) straight = classes[1];
      if (m == 1u) slanted = classes[1];
      if (m == 2u) slanted = classes[2];
      EACH_OF_RUN(ROW_OF)
      EACH_OF_ROW
      d += m > 0u ? 3u : 2u;
    }
  }
  for (int p = 0; p < ASPIC_LATTICE_RUN; ++p) {
    int place = first_place + p;
    if ((own_block >> place & 1u) != 0u) finish_stage(particle_at(body, own_block, place), own[0], force[0]);
    EACH_BUT_THE_LAST(MOVE_DOWN)
  }
}
