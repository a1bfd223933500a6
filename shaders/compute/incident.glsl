// The springs of each particle in ascending neighbour index, one word a spring, and the walk over them:
//   for (Walk w = walk(i, bounded(degree(i), KERNEL_…)); w.at < w.end; ++w.at) { Link link = link_of(w); … }
// A word is neighbour << class_bits | class; on the force path per-spring it is the spring's, see sum_springs.comp.
layout(std430, binding = BINDING_INCIDENT_START) restrict readonly buffer IncidentStart { uint incident_start[]; };
layout(std430, binding = BINDING_INCIDENT) restrict readonly buffer Incident { uint incident[]; };

struct Walk {
  uint at;   // in the incident words
  uint end;  // one past the last
};

// A spring as one of its ends sees it.
struct Link {
  uint other;  // the particle at the other end
  SpringClass spring;
};

uint degree(uint i) { return incident_start[i + 1u] - incident_start[i]; }

// The first `count` springs of particle i.
Walk walk(uint i, uint count) {
  uint first = incident_start[i];
  return Walk(first, first + count);
}

Link link_of(Walk w) {
  uint word = incident[w.at];
  return Link(word >> class_bits, spring_classes[word & ((1u << class_bits) - 1u)]);
}
