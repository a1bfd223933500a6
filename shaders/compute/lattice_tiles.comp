// Force path `lattice-tiles`: as `lattice`, but a group takes a tile of a box and keeps it, with all neighbours of its
// particles, in shared memory, so that each is read once for the tile. Bits and order are those of lattice.comp.
#include "compute/layout.glsl"
#include "compute/common.glsl"
#include "compute/control.glsl"
#include "compute/link_force.glsl"
#include "compute/stage.glsl"
#include "compute/lattices.glsl"
#include "compute/spring_classes.glsl"

// The tile and two particles on each side of it.
#define SEEN_I (TILE_I + 4)
#define SEEN_J (TILE_J + 4)
#define SEEN_K (TILE_K + 4)
#define SEEN (SEEN_I * SEEN_J * SEEN_K)

// By component, so that lanes read neighbouring words.
shared float seen_x[SEEN], seen_y[SEEN], seen_z[SEEN], seen_vx[SEEN], seen_vy[SEEN], seen_vz[SEEN];
uint cell;  // of this invocation's particle

#define READ_OTHER(di, dj, t)                                                     \
  {                                                                               \
    uint at_cell = uint(int(cell) + ((di)*SEEN_J + (dj)) * SEEN_K + (t));         \
    other_x = vec3(seen_x[at_cell], seen_y[at_cell], seen_z[at_cell]);            \
    other_v = vec3(seen_vx[at_cell], seen_vy[at_cell], seen_vz[at_cell]);         \
  }
#include "compute/lattice_rows.glsl"

uvec3 tiles_of(uvec3 size) { return (size + uvec3(TILE_I, TILE_J, TILE_K) - 1u) / uvec3(TILE_I, TILE_J, TILE_K); }

// Which lattice tile `tile` of all is in, and which of its tiles it becomes.
uint lattice_of(inout uint tile) {
  uint l = 0u;
  for (; l < lattice_count; ++l) {
    uvec3 tiles = tiles_of(size_of(lattices[l]));
    uint count = tiles.x * tiles.y * tiles.z;
    if (tile < count) break;
    tile -= count;
  }
  return l;
}

// Particles beyond the lattice's sides are those on them: no spring leads there.
void see(Lattice lattice, ivec3 first) {
  ivec3 last = ivec3(size_of(lattice)) - 1;
  for (uint n = gl_LocalInvocationIndex; n < uint(SEEN); n += uint(ASPIC_GROUP_SIZE)) {
    ivec3 place = first + ivec3(n / uint(SEEN_J * SEEN_K), n / uint(SEEN_K) % uint(SEEN_J), n % uint(SEEN_K)) - 2;
    uvec3 at = uvec3(clamp(place, ivec3(0), last));
    uint i = lattice.first_particle + (at.x * lattice.rows + at.y) * lattice.row_size + at.z;
    precise vec3 x, v;
    read_neighbour(i, x, v);
    seen_x[n] = x.x;
    seen_y[n] = x.y;
    seen_z[n] = x.z;
    seen_vx[n] = v.x;
    seen_vy[n] = v.y;
    seen_vz[n] = v.z;
  }
}

void main() {
  uint tile = item_index() / uint(ASPIC_GROUP_SIZE);
  bool exists = tile * uint(ASPIC_GROUP_SIZE) < item_end(NO_BODY);
  uint l = exists ? lattice_of(tile) : lattice_count;
  if (l == lattice_count) return;  // the whole group
  Lattice lattice = lattices[l];
  uvec3 size = size_of(lattice);
  uvec3 tiles = tiles_of(size);
  uvec3 first = uvec3(tile / (tiles.y * tiles.z), tile / tiles.z % tiles.y, tile % tiles.z) * uvec3(TILE_I, TILE_J, TILE_K);
  see(lattice, ivec3(first));
  barrier();
  uint n = gl_LocalInvocationIndex;
  uvec3 inside = uvec3(n / uint(TILE_J * TILE_K), n / uint(TILE_K) % uint(TILE_J), n % uint(TILE_K));
  uvec3 place = first + inside;
  if (any(greaterThanEqual(place, size)) || halted()) return;
  cell = ((inside.x + 2u) * uint(SEEN_J) + inside.y + 2u) * uint(SEEN_K) + inside.z + 2u;
  use_lengths(step_index, stage_index);
  for (uint c = 0u; c < LATTICE_CLASSES; ++c) classes[c] = spring_class(lattice.first_class + c);
  uint i = lattice.first_particle + (place.x * size.y + place.y) * size.z + place.z;
  own[0] = stage_state[AT(i)];
  force[0] = own[0].velocity.w * gravity.xyz;
  steps[0] = steps_from(place, size);
  EACH_LINK
  finish_stage(i, own[0], force[0]);
}
