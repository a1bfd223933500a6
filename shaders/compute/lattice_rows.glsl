// Rows of neighbors, for an invocation's run of 1 or 4 particles. EACH_LINK walks over all of them in ascending index.
#include "compute/neighbor.glsl"

Particle own[ASPIC_LATTICE_RUN];
precise vec3 force[ASPIC_LATTICE_RUN];
uint steps[ASPIC_LATTICE_RUN];
SpringClass classes[LATTICE_CLASSES];
precise vec3 other_x, other_v;

// Particle p of the run, from the state.
#define TAKE(p)                                                            \
  own[p] = stage_state[uint(min(first_of_run + (p), last_of_lattice))];   \
  force[p] = body_force(own[p].velocity.w, own[p].velocity.xyz);           \
  steps[p] = steps_from(place, size);                                      \
  place.z++;                                                               \
  if (place.z == size.z) { place.z = 0u; place.y++; }                        \
  if (place.y == size.y) { place.y = 0u; place.x++; }
#define MOVE_DOWN(p)    \
  own[p] = own[p + 1];  \
  force[p] = force[p + 1];

// The other end at t steps from the run's first particle along the row; NEAR: one of the run itself.
// Where the lattice ends, any particle will do: no spring leads there.
#ifndef READ_OTHER
#define READ_OTHER(di, dj, t)                                                 \
  {                                                                           \
    int to = first_of_run + (di)*plane_stride + (dj)*row_stride + (t);        \
    uint other = uint(clamp(to, first_of_lattice, last_of_lattice));          \
    read_neighbor(other, other_x, other_v);                                  \
  }
#endif
#define FAR(di, dj, t) READ_OTHER(di, dj, t)
#define NEAR(t)                      \
  other_x = own[t].position.xyz;     \
  other_v = own[t].velocity.xyz;
// Its force on particle p of the run, for which it lies in direction (di, dj, dk).
#define ADD_LINK(p, di, dj, dk, spring)                                                                         \
  {                                                                                                             \
    precise vec3 sum =                                                                                          \
        force[p] + link_force(spring, own[p].position.xyz, own[p].velocity.xyz, other_x, other_v).xyz;          \
    uint needed = step_bits(di, dj, dk);                                                                        \
    if ((steps[p] & needed) == needed) force[p] = sum;                                                          \
  }
#define LINK(p, di, dj, dk, spring_class)                                                                       \
  {                                                                                                             \
    SpringClass of_link = classes[spring_class];                                                                \
    ADD_LINK(p, di, dj, dk, of_link)                                                                            \
  }

#if ASPIC_LATTICE_RUN == 1
#define EACH_OF_RUN(f) f(0)
#define EACH_BUT_THE_LAST(f)
// A loop over the table, four directions a round: NVIDIA's compiler takes 4 s for all 32 one by one, which run no faster.
// It would unroll the loop, were the bound a constant.
#define DIRECTION(d)                                                                        \
  {                                                                                         \
    uint word = directions[d].word;                                                         \
    ivec3 o = steps_of(word);                                                               \
    READ_OTHER(o.x, o.y, o.z)                                                               \
    SpringClass spring = spring_class(lattice.first_class + (word >> 9));                   \
    ADD_LINK(0, o.x, o.y, o.z, spring)                                                      \
  }
#define EACH_LINK                                                                           \
  uint directions_end = lattice_count == 0u ? 0u : uint(LATTICE_DIRECTIONS);                \
  for (uint d = 0u; d < directions_end; d += 4u) {                                          \
    DIRECTION(d)                                                                            \
    DIRECTION(d + 1u)                                                                       \
    DIRECTION(d + 2u)                                                                       \
    DIRECTION(d + 3u)                                                                       \
  }
#elif ASPIC_LATTICE_RUN == 4
#define EACH_OF_RUN(f) f(0) f(1) f(2) f(3)
#define EACH_BUT_THE_LAST(f) f(0) f(1) f(2)
// Unrolled, with indices that are constants, by the program (src/gpu/lattice_links.cpp): where a loop runs over these
// arrays, Mesa puts them into memory, and one form of this kernel took 13 s to compile.
#include "compute/lattice_links.glsl"
#endif
