// The uniform grid of balls, in lists, one list a bucket, cells hashed into buckets; and each ball's marks, bits for the
// blocks of particles it touches.
layout(std430, binding = BINDING_BALL_GRID) restrict buffer BallGrid { uint grid[]; };

// Cells past ±2¹⁸ are one with those at the edge: within, rounding moves a body by less than a sixtieth of a cell, and
// half a cell is a quarter larger than the reach of a ball to a particle (src/gpu_solver/ball_passes.cpp).
const float farthest_cell = 262144.0;

// Position in cells.
vec3 in_cells(vec3 x) {
  precise vec3 scaled = x * ball_cells_per_meter;
  scaled = min(max(scaled, vec3(-farthest_cell)), vec3(farthest_cell));
  return scaled;
}

ivec3 cell_of(vec3 x) { return ivec3(floor(in_cells(x))); }

uint head_of(ivec3 cell) {
  uvec3 c = uvec3(cell) * uvec3(73856093u, 19349663u, 83492791u);
  uint hash = c.x ^ c.y ^ c.z;
  hash ^= hash >> 15u;
  return hash & bucket_mask;
}

uint link_of(uint b) { return bucket_mask + 1u + b; }

uint blocks_of(uint count) { return (count + PARTNER_BLOCK - 1u) / PARTNER_BLOCK; }

// Words of a ball's row of marks, and where the row begins.
uint mark_words() {
  uint marks = (blocks_of(particle_count) + (1u << mark_shift) - 1u) >> mark_shift;
  return (marks + 31u) / 32u;
}
uint marks_of(uint b) { return bucket_mask + 1u + ball_count + b * mark_words(); }

void mark(uint b, uint particle) {
  uint bit = (particle / PARTNER_BLOCK) >> mark_shift;
  atomicOr(grid[marks_of(b) + bit / 32u], 1u << (bit % 32u));
}
