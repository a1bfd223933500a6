// Force path `lattice`: gather for boxes, whose springs follow from the particles' indices. An invocation takes
// ASPIC_LATTICE_RUN particles that lie one after the other, so that each neighbor is read once for all of them. The
// neighbors come in ascending index, so every particle adds its springs in that order; one that lies outside the lattice
// is left out of the sum.
#include "compute/layout.glsl"
#include "compute/common.glsl"
#include "compute/control.glsl"
#include "compute/terms/link_force.glsl"
#include "compute/stage.glsl"
#include "compute/lattices.glsl"
#include "compute/spring_classes.glsl"
#include "compute/lattice_rows.glsl"

// Which lattice run `run` of all is in, and which of its runs it becomes.
uint lattice_of(inout uint run) {
  uint l = 0u;
  for (; l < lattice_count; ++l) {
    uint runs = (particles_of(lattices[l]) + ASPIC_LATTICE_RUN - 1u) / ASPIC_LATTICE_RUN;
    if (run < runs) break;
    run -= runs;
  }
  return l;
}

void main() {
  uint run = item_index();
  uint l = lattice_of(run);
  if (l == lattice_count || halted()) return;
  GpuLattice lattice = lattices[l];
  uvec3 size = size_of(lattice);
  uint at = run * ASPIC_LATTICE_RUN;
  int first_of_lattice = int(lattice.first_particle);
  int last_of_lattice = int(lattice.first_particle + particles_of(lattice) - 1u);
  int first_of_run = first_of_lattice + int(at);
  int row_stride = int(size.z), plane_stride = int(size.y * size.z);
  use_lengths(step_index, stage_index);
  for (uint c = 0u; c < LATTICE_CLASSES; ++c) classes[c] = spring_class(lattice.first_class + c);
  uvec3 place = place_in(size, at);
  EACH_OF_RUN(TAKE)
  EACH_LINK
  for (int p = 0; p < ASPIC_LATTICE_RUN && first_of_run + p <= last_of_lattice; ++p) {
    finish_stage(uint(first_of_run + p), own[0], force[0]);
    EACH_BUT_THE_LAST(MOVE_DOWN)
  }
}
