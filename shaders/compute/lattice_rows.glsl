// Rows of neighbours, for an invocation's run of 1 or 4 particles. A row is (di, dj), of the particles at di planes and dj
// rows from the run; ROW_n reaches n steps along it. Everything is unrolled by hand, with indices that are constants: where
// a loop runs over these arrays, Mesa puts them into memory, and one form of this kernel took 13 s to compile.
#include "compute/neighbour.glsl"

Particle own[ASPIC_LATTICE_RUN];
precise vec3 force[ASPIC_LATTICE_RUN];
uint steps[ASPIC_LATTICE_RUN];
SpringClass classes[LATTICE_CLASSES];
precise vec3 other_x, other_v;

// Particle p of the run, from the state.
#define TAKE(p)                                                            \
  own[p] = stage_state[AT(uint(min(first_of_run + (p), last_of_lattice)))];   \
  force[p] = own[p].velocity.w * gravity.xyz;                              \
  steps[p] = steps_from(place, edge);                                      \
  place.z++;                                                               \
  if (place.z == edge) { place.z = 0u; place.y++; }                        \
  if (place.y == edge) { place.y = 0u; place.x++; }
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
    read_neighbour(other, other_x, other_v);                                  \
  }
#endif
#define FAR(di, dj, t) READ_OTHER(di, dj, t)
#define NEAR(t)                      \
  other_x = own[t].position.xyz;     \
  other_v = own[t].velocity.xyz;
// Its force on particle p of the run, for which it lies in direction (di, dj, dk).
#define LINK(p, di, dj, dk)                                                                                     \
  {                                                                                                             \
    SpringClass spring = classes[(di) * (di) + (dj) * (dj) + (dk) * (dk)-1];                                    \
    precise vec3 sum =                                                                                          \
        force[p] + link_force(spring, own[p].position.xyz, own[p].velocity.xyz, other_x, other_v).xyz;        \
    uint needed = step_bits(di, dj, dk);                                                                        \
    if ((steps[p] & needed) == needed) force[p] = sum;                                                          \
  }

#if ASPIC_LATTICE_RUN == 1
#define EACH_OF_RUN(f) f(0)
#define EACH_BUT_THE_LAST(f)
#define ROW_0(i, j) FAR(i, j, 0) LINK(0, i, j, 0)
#define ROW_1(i, j)                                        \
  FAR(i, j, -1) LINK(0, i, j, -1)                          \
  FAR(i, j, 0) LINK(0, i, j, 0)                            \
  FAR(i, j, 1) LINK(0, i, j, 1)
#define ROW_2                                              \
  FAR(0, 0, -2) LINK(0, 0, 0, -2)                          \
  FAR(0, 0, -1) LINK(0, 0, 0, -1)                          \
  FAR(0, 0, 1) LINK(0, 0, 0, 1)                            \
  FAR(0, 0, 2) LINK(0, 0, 0, 2)
#elif ASPIC_LATTICE_RUN == 4
#define EACH_OF_RUN(f) f(0) f(1) f(2) f(3)
#define EACH_BUT_THE_LAST(f) f(0) f(1) f(2)
#define ROW_0(i, j)                                        \
  FAR(i, j, 0) LINK(0, i, j, 0)                            \
  FAR(i, j, 1) LINK(1, i, j, 0)                            \
  FAR(i, j, 2) LINK(2, i, j, 0)                            \
  FAR(i, j, 3) LINK(3, i, j, 0)
#define ROW_1(i, j)                                                        \
  FAR(i, j, -1) LINK(0, i, j, -1)                                          \
  FAR(i, j, 0) LINK(0, i, j, 0) LINK(1, i, j, -1)                          \
  FAR(i, j, 1) LINK(0, i, j, 1) LINK(1, i, j, 0) LINK(2, i, j, -1)         \
  FAR(i, j, 2) LINK(1, i, j, 1) LINK(2, i, j, 0) LINK(3, i, j, -1)         \
  FAR(i, j, 3) LINK(2, i, j, 1) LINK(3, i, j, 0)                           \
  FAR(i, j, 4) LINK(3, i, j, 1)
#define ROW_2                                                              \
  FAR(0, 0, -2) LINK(0, 0, 0, -2)                                          \
  FAR(0, 0, -1) LINK(0, 0, 0, -1) LINK(1, 0, 0, -2)                        \
  NEAR(0) LINK(1, 0, 0, -1) LINK(2, 0, 0, -2)                              \
  NEAR(1) LINK(0, 0, 0, 1) LINK(2, 0, 0, -1) LINK(3, 0, 0, -2)             \
  NEAR(2) LINK(0, 0, 0, 2) LINK(1, 0, 0, 1) LINK(3, 0, 0, -1)              \
  NEAR(3) LINK(1, 0, 0, 2) LINK(2, 0, 0, 1)                                \
  FAR(0, 0, 4) LINK(2, 0, 0, 2) LINK(3, 0, 0, 1)                           \
  FAR(0, 0, 5) LINK(3, 0, 0, 2)
#endif

// All rows, in ascending index of the neighbours.
#define EACH_ROW                                              \
  ROW_0(-2, 0) ROW_1(-1, -1) ROW_1(-1, 0) ROW_1(-1, 1)        \
  ROW_0(0, -2) ROW_1(0, -1) ROW_2 ROW_1(0, 1) ROW_0(0, 2)     \
  ROW_1(1, -1) ROW_1(1, 0) ROW_1(1, 1) ROW_0(2, 0)
