// The tetrahedra of a lattice's cells that the section's plane crosses, as indices for a draw. Every cell is divided in the
// same way, along its diagonal from the lowest corner to the highest (Freudenthal, 1942; Kuhn, 1960): so neighbours agree
// on the faces they share, and with the triangles of the skin.
#include "render/layout.glsl"
#include "compute/dispatch.glsl"

layout(std430, binding = BINDING_PARTICLES) restrict readonly buffer Particles { Particle particles[]; };
layout(std430, binding = BINDING_SECTION) restrict buffer Section {
  SectionDraw draw;
  uvec4 tetrahedra[];
};
layout(location = LOCATION_FIRST) uniform uint first_particle;
layout(location = LOCATION_LATTICE) uniform uvec4 size;
layout(location = LOCATION_CELL) uniform uint first_cell;
layout(location = LOCATION_COUNT) uniform uint cell_count;

bool beyond(uint particle) { return dot(cut.xyz, particles[particle].position.xyz) > section.x; }

void main() {
  uint item = item_index();
  if (item >= cell_count) return;
  uint cell = first_cell + item;
  uvec3 cells = size.xyz - 1u;
  uvec3 stride = uvec3(size.y * size.z, size.z, 1u);
  uint lowest = first_particle + cell / (cells.y * cells.z) * stride.x + cell / cells.z % cells.y * stride.y + cell % cells.z;
  uint sides = 0u;  // a bit for each corner, whose number has one for each axis
  for (uint corner = 0u; corner < 8u; ++corner) {
    uint particle = lowest + (corner & 1u) * stride.x + (corner >> 1 & 1u) * stride.y + (corner >> 2) * stride.z;
    if (beyond(particle)) sides |= 1u << corner;
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
    tetrahedra[slot] = lowest + uvec4(0u, stride[a], stride[a] + stride[b], stride.x + stride.y + stride.z);
  }
}
