// The springs of each particle in ascending neighbor index, and the walk over them:
//   for (Walk w = walk(i); w.at < w.end; ++w.at) { Link link; if (!link_at(w, link)) continue; … }
// A word is neighbor << class_bits | class; on the force path per-spring it is the spring's, see sum_springs.comp.
// With ASPIC_LATTICES those of lattices follow from the indices; ASPIC_LISTED: there are particles outside them too.
#include "compute/spring_classes.glsl"

#ifndef ASPIC_ACTUATED
layout(std430, binding = BINDING_INCIDENT_START) restrict readonly buffer IncidentStart { uint incident_start[]; };
#endif
layout(std430, binding = BINDING_INCIDENT) restrict readonly buffer Incident { uint incident[]; };

#ifdef ASPIC_LATTICES
#include "compute/lattices.glsl"
#endif

struct Walk {
  uint at;     // springs passed so far, some of which may be missing
  uint end;    // where it ends
  uint first;  // the first of its words
#ifdef ASPIC_LATTICES
  uint particle;
  uint steps;  // of a particle in a lattice: those that stay inside
  int plane_stride, row_stride;  // of its lattice; 0: its springs are listed
  uint first_class;
#endif
};

// A spring as one of its ends sees it.
struct Link {
  uint other;  // the particle at the other end
  SpringClass spring;
};

// The walk over the words of the particle at this place among those that have any.
Walk walk_words(uint place) {
  uint slice = place / SPRING_SLICE;
  uint first = incident_start[INCIDENT_HEAD + slice];
  uint count = (incident_start[INCIDENT_HEAD + slice + 1u] - first) / SPRING_SLICE;
#ifdef ASPIC_LATTICES
  return Walk(0u, count, first + place % SPRING_SLICE, 0u, 0u, 0, 0, 0u);
#else
  return Walk(0u, count, first + place % SPRING_SLICE);
#endif
}

uint word_at(Walk w) { return incident[w.first + w.at * SPRING_SLICE]; }

// False where a walk over words has no spring.
bool listed_link_at(Walk w, out Link link) {
  uint word = word_at(w);
  link = Link(word >> class_bits, spring_class(word & ((1u << class_bits) - 1u)));
  return word != NO_SPRING;
}

#ifdef ASPIC_LATTICES
Walk walk(uint i) {
  uint place = i, l = 0u;
  for (; l < lattice_count && i >= lattices[l].first_particle + particles_of(lattices[l]); ++l) {
    place -= particles_of(lattices[l]);
  }
#ifdef ASPIC_LISTED
  if (l == lattice_count || i < lattices[l].first_particle) return walk_words(place);
#endif
  GpuLattice lattice = lattices[l];
  uvec3 size = size_of(lattice);
  uint steps = steps_from(place_in(size, i - lattice.first_particle), size);
  // A bound that compilers cannot see: with a constant, NVIDIA's unrolls the walk and takes seconds.
  uint end = lattice_count == 0u ? 0u : uint(LATTICE_DIRECTIONS);
  return Walk(0u, end, 0u, i, steps, int(size.y * size.z), int(size.z), lattice.first_class);
}

bool link_at(Walk w, out Link link) {
#ifdef ASPIC_LISTED
  if (w.plane_stride == 0) return listed_link_at(w, link);
#endif
  uint word = directions[w.at].word;
  ivec3 o = steps_of(word);
  uint bits = step_bits(o.x, o.y, o.z);
  link = Link(w.particle + uint(o.x * w.plane_stride + o.y * w.row_stride + o.z), spring_class(w.first_class + (word >> 9)));
  return (w.steps & bits) == bits;
}
#else
Walk walk(uint i) { return walk_words(i); }
bool link_at(Walk w, out Link link) { return listed_link_at(w, link); }
#endif
