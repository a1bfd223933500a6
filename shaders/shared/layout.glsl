// Bindings, bounds of loops and structs of buffers that compute and drawing share: solvers fill them, images show
// them. Read by GLSL and by C++ (src/device/layout.h).
#ifndef SHARED_LAYOUT
#define SHARED_LAYOUT

// Storage blocks of the explicit kernels.
#define BINDING_START_STATE 0   // Particle[]: the state the step began with, read only
#define BINDING_STAGE_STATE 1   // Particle[]: where this stage evaluates the force, read only
#define BINDING_OUT_STATE 2     // Particle[]: the next stage's state, or the step's end
#define BINDING_STAGE_SUMS 3    // Particle[]: weighted sums of the stages' slopes so far
#define BINDING_INCIDENT_START 4  // uint[slices + 1]: where the words of each slice of particles begin
#define BINDING_INCIDENT 5      // uint[]: per-spring: spring and side; else neighbor and class
#define BINDING_CONTROL 6       // Control
#define BINDING_CELLS 7         // uint[], in the kernel of cells only: src/model/cell_blocks.h
#define BINDING_SPRING_FORCES 7 // vec4[springs]: force on end a [N], signed spring strength s [N]
#define BINDING_SPRINGS 4       // uvec2[springs], in the per-spring force pass only
#define BINDING_SPRING_LENGTHS 5  // there alone: rest lengths that change, which others have in INCIDENT_START
// Of the implicit kernels, where they differ.
#define BINDING_STATE_A 0       // Particle[]: the state, or where the step's end goes: Solve.parity tells
#define BINDING_STATE_B 1       // Particle[]: the other one
#define BINDING_TRIAL 2         // vec4[particles]: v' at which the residual is evaluated [m/s]
#define BINDING_SEARCH 3        // vec4[particles]: conjugate gradients' search direction p [m/s]
#define BINDING_SOLVE 6         // Solve, then vec4[blocks]: the reductions' partial results
#define BINDING_OWN 7           // vec4[OWN_VECTORS · particles]: what only its own invocation writes
// Of the ball kernels; particles are STATE_A and STATE_B: the step's start and its end.
#define BINDING_BALLS 2         // Ball[BALL_SLOTS · balls]
#define BINDING_BALL_BODIES 3   // BallBody[balls]
#define BINDING_BALL_ITEMS 3    // BallItem[], in every ball kernel but flight
#define BINDING_BALL_CONTACTS 4  // BallContacts[balls + particles]
#define BINDING_BALL_GRID 5     // uint[buckets + balls + balls · mark words]: heads of lists, their links, marks
#define BINDING_BALL_WORK 7     // BallWork, then uint[]: the short lists of partners
// Of the kernels of contact between bodies; the step's start and the stage as in the explicit kernels, OUT_STATE with
// forces in the place of velocities.
#define BINDING_CONTACT_LISTED 1      // ContactParticle[]: particles that contacts may name
#define BINDING_CONTACT_PLACES 3      // uvec4[]: bits of where particles were when lists were made; w: which particle
#define BINDING_CONTACT_TRIANGLES 3   // uvec4[]: corners; w: side
#define BINDING_CONTACT_VALUES 3      // vec4[particles]: v₁ [m/s]; w: S [N]
#define BINDING_CANDIDATE_GROUPS 4  // CandidateGroup[]
#define BINDING_CONTACT_WORDS 5       // uint[]: lists of triangles and of candidate groups
#define BINDING_CONTACT_RECORDS 7     // ContactRecord[CONTACT_RECORDS · candidate groups]
// Bindings of kernels that prepare an image; springs and balls as above.
#define BINDING_PARTICLES 0   // Particle[]
#define BINDING_FAN_START 1   // uint[surface vertices + 1]: where each vertex's fan begins
#define BINDING_FAN 2         // uvec2[]: next and previous neighbor along each quad at the vertex
#define BINDING_FAN_VERTEX 3  // uint[surface vertices]: the particle
#define BINDING_SKIN 4        // SkinVertex[surface vertices]
#define BINDING_FAN_OWN 5     // uint[surface vertices]: where the quads of its own patch end
#define BINDING_BOUNDS 5      // Bounds[LIGHTS]
#define BINDING_QUANTITY 6    // float[particles]
#define BINDING_LIGHT_BOXES_OUT 7  // LightBox[LIGHTS]
#define BINDING_EXTREMES 7    // uint[EXTREMES]: of what colors show
#define BINDING_SPRING_CLASSES 3   // SpringClass[]
#define BINDING_SECTION 2     // Section, then uvec4[]: tetrahedra that a cut crosses
#define BINDING_SECTION_CELLS 1  // uint[8 · cells]: corners of the full cells of a lattice
#define BINDING_TURNS 1       // vec4[balls]: unit quaternions, from a ball's own frame to the world

// Uniform blocks of the solvers' kernels, and of images.
#define BINDING_SIMULATION 0
#define BINDING_PULLS 1
#define BINDING_POSES 2
#define BINDING_LATTICES 3
#define BINDING_CELL_BODIES 4
#define BINDING_FRAME 1
#define BINDING_LIGHT_BOXES 2

// Bounds of loops. Some drivers end the loops of an invocation silently after so many rounds in all (Mesa's llvmpipe
// after 65,535, counted over the invocations that share a vector). So every loop whose length depends on the scene has
// at most MAX_ROUNDS rounds, none is inside another, and no kernel has more than three, one after the other.
// What would take more is reported (Control.overrun, Solve.overrun) and ends the run with an error.
#ifndef MAX_ROUNDS
#define MAX_ROUNDS 20000u
#endif

// Particles whose words lie side by side: spring_slice in src/model/incident_springs.h.
#define SPRING_SLICE 32u
#define NO_SPRING 0xffffffffu  // the word where a particle has fewer springs than others of its slice

// Springs of a particle inside a lattice; their classes; lattices of a model, each with its own classes.
#define LATTICE_DIRECTIONS 32
#define LATTICE_CLASSES 4
#define MAX_LATTICES 64
// Bodies of cells, src/model/cell_blocks.h: places of a block, bits of its number in a record, words of a record.
#define BLOCK_PLACES 4u
#define BLOCK_BITS 26u
#define PLAIN_WORDS 3u
#define MIXED_WORDS 5u
#define HALF_WORDS(class_width) (5u * (class_width) / 8u)  // of half a pattern

struct Particle {
  vec4 position;  // x [m]; w: inverse mass [1/kg], 0 = pinned
  vec4 velocity;  // v [m/s]; w: mass [kg]
};

struct Ball {
  vec4 position;        // x [m]; w: radius R [m]
  vec4 velocity;        // v [m/s]; w: inverse mass [1/kg], 0 while it is not launched
  vec4 spin;            // ω [rad/s]; w: R/I [1/(kg·m)]
  vec4 start_velocity;  // v at the start of the step [m/s], between phases; w: R²/I [1/kg]
};

struct SpringClass {
  float stiffness;    // k [N/m]
  float damping;      // c [N·s/m]
  float rest_length;  // r [m]
  uint cord;          // 1: resists stretch only
};

// A direction in which particles of a lattice have a spring (LatticeDirection in src/model/lattice.h), in one word, since
// software rasterizers read words one by one: di + 2, dj + 2 and dk + 2 in three bits each, then the class's number.
struct Direction {
  uint word;
  uint direction_padding0, direction_padding1, direction_padding2;
};

// Particles of a lattice whose cells are all full, along i, j and k: their springs are not in memory.
struct GpuLattice {
  uint first_particle;
  uint first_class;
  uint planes;    // along i
  uint rows;      // along j
  uint row_size;  // along k
  uint lattice_padding0, lattice_padding1, lattice_padding2;
};

// Consecutive particles whose springs are in no list: those of a lattice or of a body of cells.
struct Unlisted {
  uint first;
  uint count;
  uint unlisted_padding0, unlisted_padding1;
};

// A body of cells: its particles, and its blocks in the map.
struct CellBody {
  uint first_particle;
  uint last_particle;
  uint first_class;
  uint first_block;
  uint last_block;
  uint row_blocks;    // blocks from one row to the next
  uint plane_blocks;  // and from one plane
  uint cell_body_padding;
};

#if defined(__cplusplus) || defined(ASPIC_LATTICES)
#ifdef __cplusplus
struct Lattices {
#else
layout(std140, binding = BINDING_LATTICES) uniform Lattices {
#endif
  uint lattice_count;
  uint listed_count;  // particles whose springs are in lists
  uint unlisted_count;
  uint lattices_padding;
  Direction directions[LATTICE_DIRECTIONS];
  GpuLattice lattices[MAX_LATTICES];  // in ascending order of particles, as those that follow
  Unlisted unlisted[2 * MAX_LATTICES];
};

#ifdef __cplusplus
struct Cells {
#else
layout(std140, binding = BINDING_CELL_BODIES) uniform Cells {
#endif
  uint plain_first;     // where the records of plain blocks begin, behind the map
  uint mixed_first;     // those of all others
  uint patterns_first;  // the patterns of plain blocks
  uint halves_first;    // and the halves of all others
  uint plain_count;     // records
  uint mixed_count;
  uint cells_padding0, cells_padding1;
  CellBody cell_bodies[MAX_LATTICES];
};
#endif

#endif
