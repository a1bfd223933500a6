// The uniform grid: bodies in lists, one list a bucket, cells hashed into buckets. Balls and particles apart.
layout(std430, binding = BINDING_BALL_GRID) restrict buffer BallGrid { uint grid[]; };

// Cells past ±2²⁰ are one with those at the edge: within, rounding moves a body by less than a sixteenth of a cell,
// and cells are a quarter larger than the reach (src/gpu_solver/ball_passes.cpp).
const int farthest_cell = 1048576;

ivec3 cell_of(uint kind, vec3 x) {
  precise float cells = kind == 0u ? ball_cells_per_metre : particle_cells_per_metre;
  precise vec3 scaled = min(max(x * cells, vec3(-farthest_cell)), vec3(farthest_cell));
  return ivec3(floor(scaled));
}

uint head_of(uint kind, ivec3 cell) {
  uvec3 c = uvec3(cell) * uvec3(73856093u, 19349663u, 83492791u);
  uint hash = c.x ^ c.y ^ c.z;
  hash ^= hash >> 15u;
  return (hash & bucket_mask) + (kind == 0u ? 0u : bucket_mask + 1u);
}

uint link_of(uint kind, uint index) { return 2u * (bucket_mask + 1u) + (kind == 0u ? 0u : ball_count) + index; }
