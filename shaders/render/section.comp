// The tetrahedra of a lattice's cells that the section's plane crosses, as indices for a draw. Every cell is divided in the
// same way, along its diagonal from the lowest corner to the highest (Freudenthal, 1942; Kuhn, 1960): so neighbors agree
// on the faces they share, and with the triangles of the skin. With LISTED_CELLS the lattice has empty cells, and the
// corners of its full ones are in memory.
#include "render/layout.glsl"
#include "compute/dispatch.glsl"

layout(std430, binding = BINDING_PARTICLES) restrict readonly buffer Particles { Particle particles[]; };
layout(std430, binding = BINDING_SECTION) restrict buffer Section {
  SectionDraw draw;
  uvec4 tetrahedra[];
};
#ifdef LISTED_CELLS
layout(std430, binding = BINDING_SECTION_CELLS) restrict readonly buffer Cells { uint corners[]; };
#endif
layout(location = LOCATION_FIRST) uniform uint first_particle;
#ifndef LISTED_CELLS
layout(location = LOCATION_LATTICE) uniform uvec4 size;
#endif
layout(location = LOCATION_CELL) uniform uint first_cell;
layout(location = LOCATION_COUNT) uniform uint cell_count;

bool beyond(uint particle) { return dot(cut.xyz, particles[particle].position.xyz) > section.x; }

// The particle at a corner of a cell, whose number has a bit for each axis.
uint corner_of(uint cell, uint corner) {
#ifdef LISTED_CELLS
  return first_particle + corners[8u * cell + corner];
#else
  uvec3 cells = size.xyz - 1u;
  uvec3 place = uvec3(cell / (cells.y * cells.z), cell / cells.z % cells.y, cell % cells.z);
  place += (uvec3(corner) >> uvec3(0u, 1u, 2u)) & 1u;
  return first_particle + (place.x * size.y + place.y) * size.z + place.z;
#endif
}

void main() {
  uint item = item_index();
  if (item >= cell_count) return;
  uint cell = first_cell + item;
  uint sides = 0u;  // a bit for each corner
  for (uint corner = 0u; corner < 8u; ++corner) {
    if (beyond(corner_of(cell, corner))) sides |= 1u << corner;
  }
  if (sides == 0u || sides == 255u) return;

  for (uint i = 0u; i < 6u; ++i) {
    // The order in which the way from corner to corner takes the axes.
    uint a = i >> 1;
    uint b = (a + 1u + (i & 1u)) % 3u;
    uint second = 1u << a;
    uint third = second | 1u << b;
    uint of_its_own = 1u | 1u << second | 1u << third | 128u;
    uint crossed = sides & of_its_own;
    if (crossed == 0u || crossed == of_its_own) continue;
    uint slot = atomicAdd(draw.indices, 4u) / 4u;
    tetrahedra[slot] = uvec4(corner_of(cell, 0u), corner_of(cell, second), corner_of(cell, third), corner_of(cell, 7u));
  }
}
