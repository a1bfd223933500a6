// Lattices whose springs follow from the particles' indices, and the particles whose springs are listed.
uvec3 size_of(GpuLattice lattice) { return uvec3(lattice.planes, lattice.rows, lattice.row_size); }
uint particles_of(GpuLattice lattice) { return lattice.planes * lattice.rows * lattice.row_size; }

// The particle at this place among those whose springs are listed.
uint listed_particle(uint place) {
  uint i = place;
  for (uint l = 0u; l < unlisted_count; ++l) {
    if (i >= unlisted[l].first) i += unlisted[l].count;
  }
  return i;
}

// Bit d + 2 for each step d that stays inside the lattice along one axis.
uint steps_from(uint place, uint count) {
  return (place >= 2u ? 1u : 0u) | (place >= 1u ? 2u : 0u) | 4u | (place + 1u < count ? 8u : 0u) |
         (place + 2u < count ? 16u : 0u);
}

// The same for all three: five bits each along i, j and k.
uint steps_from(uvec3 place, uvec3 size) {
  return steps_from(place.x, size.x) | (steps_from(place.y, size.y) << 5) | (steps_from(place.z, size.z) << 10);
}

// The steps of a word of the table of directions.
ivec3 steps_of(uint word) { return ivec3((uvec3(word) >> uvec3(0u, 3u, 6u)) & 7u) - 2; }

uint step_bits(int di, int dj, int dk) { return (1u << (di + 2)) | (1u << (dj + 7)) | (1u << (dk + 12)); }

uvec3 place_in(uvec3 size, uint at) {
  return uvec3(at / (size.y * size.z), (at / size.z) % size.y, at % size.z);
}
