// The solvers' structs, uniform locations and limits, read by GLSL and by C++ (src/gpu_solver/layout.h).
// vec4 and uvec4 only, or scalars in groups of four: then std140, std430 and C++ agree on every offset.
#include "shared/layout.glsl"

// Of those of balls and faces.
#define BINDING_BALL_FACES 3        // uvec4[]: bodies and blocks; each body's first block, blocks, 1 if closed; corners
#define BINDING_BALL_FACE_COUNTS 4  // BallFaceCount[balls + particles]
#define BINDING_BALL_FACE_BOXES 5   // vec4[2 · blocks]: low and high corners
#define BINDING_BALL_FACE_PAIRS 7   // BallFacePair[balls · bodies with faces]

#define MAX_STAGES 4
#define MAX_SPRING_CLASSES 640
#define MAX_TERRAINS 64
#define MAX_PULLS 256  // most_pulls of include/aspic/inputs.h
#define MAX_POSES 510  // of moving terrain, in the table of the next steps: 16 KiB with its head
// With ASPIC_ACTUATED the buffer of BINDING_INCIDENT_START has these words before the starts, then the constants of the spring
// classes (k, c, whether cord), then rest lengths: for each stage of the next steps a row of all classes.
#define LENGTHS_FIRST_STEP 0u  // step of the first row
#define LENGTHS_STAGES 1u      // rows of a step
#define LENGTHS_CLASSES 2u     // numbers of a row
#define LENGTHS_CONSTANTS 3u   // where the constants begin
#define LENGTHS_ROWS 4u        // where the rows begin
#define LENGTHS_HEAD 8u
// Rows of a step of implicit Euler.
#define LENGTHS_AT_START 0u
#define LENGTHS_AT_END 1u
#define GEOMETRY_SIZE 3  // vectors, and numbers, of a shape: geometry_size in include/aspic/settings.h

// Vectors of the OWN block, each an array over particles.
#define OWN_BASE 0u       // v' of the accepted Newton iterate [m/s]
#define OWN_DELTA 1u      // Newton's step δ [m/s]
#define OWN_RESIDUAL 2u   // r = right-hand side − A·δ [kg·m/s]
#define OWN_Z 3u          // preconditioned r [m/s]
#define OWN_PRODUCT 4u    // A·p [kg·m/s]
#define OWN_HELD 5u       // contact force held during the step [N]
#define OWN_INVERSE_A 6u  // inverse diagonal block: xx, yy, zz [1/kg]
#define OWN_INVERSE_B 7u  // xy, xz, yz [1/kg]
#define OWN_GROUND 8u     // ground: normal of the plane or direction of the line it leaves; w: FREE_…
#define OWN_ACROSS 9u     // ground: direction across the slip; w: stiffness there [kg]
#define OWN_PRESCRIBED 10u  // ground: part of δ that it leaves no choice in [m/s]; w: terrains that hold, see held_word
#define OWN_VECTORS 11u

// Contact of bodies in implicit Euler: arrays over particles behind that of the search directions.
#define CONTACT_START_FORCE 0u     // gravity, springs and pulls where the step begins [N]; w: inverse mass [1/kg]
#define CONTACT_START_VELOCITY 1u  // there [m/s]
#define CONTACT_FORCE 2u           // of contacts at the trial [N]
#define CONTACT_DIAGONAL 3u        // their part of the diagonal block: xx, yy, zz [kg]
#define CONTACT_MIXED 4u           // xy, xz, yz [kg]
#define CONTACT_PRODUCT 5u         // of their matrix with the direction [kg·m/s]
#define CONTACT_PRESCRIBED 6u      // as OWN_PRESCRIBED
#define CONTACT_VECTORS 7u
#define CONTACT_AT(which, i) (((which) + 1u) * particle_count + (i))

// Directions that the ground leaves free: Freedom in src/physics/terrain/implicit.h.
#define FREE_ALL 0.0
#define FREE_PLANE 1.0
#define FREE_LINE 2.0
#define FREE_NONE 3.0

// Share of ε that parallel terrains may lie apart and be one surface (src/model/implicit.h).
#define SAME_SURFACE_SHARE 0.0009765625

// Elements of one block of a reduction, and the group size of every kernel that takes part in one (docs/determinism.md).
#define REDUCTION_BLOCK 256

// How a solve ended: SolveEnd in include/aspic/solver.h.
#define SOLVE_CONVERGED 0u
#define SOLVE_STAGNATED 1u
#define SOLVE_NOT_CONVERGED 2u

#define PHASE_IDLE 0u      // all steps asked for are done
#define PHASE_BEGIN 1u     // a step begins
#define PHASE_EVALUATE 2u  // the residual at the trial is wanted
#define PHASE_CG 3u        // a linear system is being solved
#define PHASE_CONTACT 7u     // the same, and before it contacts of bodies are looked for
#define PHASE_BALLS 6u     // the particles' step has ended, the balls' has not
#define PHASE_DONE 4u      // v' is found: the step can end
#define PHASE_HALTED 5u    // the step diverged: nothing moves any more

// Uniform locations.
#define LOCATION_STEP 0   // index of the step since the state was loaded
#define LOCATION_STAGE 1  // index of the stage within the step
#define LOCATION_BALL_PARITY 2  // explicit methods: slot of the balls' state at the start of the step
#define LOCATION_BALL_PHASE 3   // BALL_PHASE_…
#define LOCATION_BALL_KIND 4    // KIND_… of the candidates that a dispatch looks at
#define LOCATION_CONTACT_COUNT 7  // candidate groups, or particles, of a dispatch
#define LOCATION_CONTACT_NUMBER 8  // seconds since the initial state, or the square of a way [m²]

// Of the items of a pass, each COUNTED_ITEMS-th and the last count themselves, so that a device which drops some is found out.
#define COUNTED_ITEMS 4096u
#define COUNTED_OF(count) (((count) - 1u) / COUNTED_ITEMS + 1u + (((count) - 1u) % COUNTED_ITEMS == 0u ? 0u : 1u))

// Ball slots: two that take turns as start and end of a step, and one between phases.
#define BALL_SLOTS 3u
#define BALL_SLOT_BETWEEN 2u

// Phases of a step in which balls meet others, in their order.
#define BALL_PHASE_BALLS 0u      // velocities, ball and ball
#define BALL_PHASE_PARTICLES 1u  // velocities, ball and particle
#define BALL_PHASE_POSITIONS 2u  // overlaps of either kind
#define BALL_PHASES 3u
// The same with faces, after all of these.
#define BALL_PHASE_FACES 3u           // velocities
#define BALL_PHASE_FACE_POSITIONS 4u  // overlaps

#define NO_BODY 0xffffffffu

#define KIND_BALL 0u
#define KIND_PARTICLE 1u

// Partners of one block of a sum, and candidates of one BallItem.
#define PARTNER_BLOCK 256u
// Words of 32 candidates in a BallItem.
#define ITEM_WORDS 8u
// Most ball partners of a body that are kept as a list; bodies with more of them are crowded.
#define LIST_SIZE 32u
#define CROWDED 0xffffffffu
// Groups along x of the dispatches whose size the device decides: along y a dispatch may have 65,535.
#define BALL_GROUPS_X 8u

// Candidates that an invocation looks at before it calls its body crowded, which is slower and as right.
#ifndef MAX_WALK
#define MAX_WALK 16384u
#endif

// Kernels that report loops over MAX_ROUNDS; their names are in src/gpu_solver/kernels.cpp.
#define KERNEL_GATHER 1u
#define KERNEL_SUM_SPRINGS 2u
#define KERNEL_IMPLICIT_BEGIN 3u
#define KERNEL_IMPLICIT_EVALUATE 4u
#define KERNEL_IMPLICIT_APPLY 5u
#define KERNEL_BALL_FIND 6u
#define KERNEL_BALL_GATHER 7u
#define KERNEL_BALL_PARTIALS 8u
#define KERNEL_BALL_EXCHANGE 9u
#define KERNEL_BALL_PARTICLES 10u
#define KERNEL_BALL_FACES 11u
#define KERNEL_COUNT 12u
#define ITEMS_MISSING 12u  // in place of a kernel: items of a pass that were not carried out

#define DRIFT_STAGE_VELOCITY 0u  // Drift in src/model/integrator.h
#define DRIFT_NEW_VELOCITY 1u
#define DRIFT_MEAN_VELOCITY 2u

#define CONTACT_COULOMB 0u
#define CONTACT_COURSE 1u

#define NO_STEP 0xffffffffu
#define BAD_RESIDUAL 0xfffffffeu  // in place of a particle that diverged: the implicit solve's residual did

struct BallBody {
  float ball_mass;          // m [kg]
  float ball_inverse_mass;  // 1/m [1/kg]
  uint launch_step;         // first step it takes part in, counted since the state was loaded
  uint ball_padding;
};

// Whom a body touches in a step: balls in a list or, if it is crowded, in items; a ball's particles in items.
struct BallContacts {
  uint pairs[3];     // acting or overlapping pairs in each phase
  uint listed;       // length of its list, or CROWDED
  uint list;         // where it begins in the lists; crowded: its first item, of as many as there are blocks of balls
  uint acting;       // bit i: entry i of the list acts in the phase of velocities
  uint overlapping;  // bit i: entry i of the list overlaps
  uint items;        // of a ball: its first item with particles, or NO_BODY
};

// 256 candidates in a row for one body: a bit for each.
struct BallItem {
  uint body;         // whose: ball, or balls + particle
  uint kind;         // KIND_… of the candidates
  uint first;        // first candidate, a multiple of PARTNER_BLOCK
  uint total;        // how many items of this kind the body has, in a row
  uint acting;       // set bits of each kind
  uint overlapping;
  uint item_padding0, item_padding1;
  uint acts[8];      // nearer than ε; once velocities are known, those of them that act
  uint overlaps[8];
  vec4 linear;       // impulse or shift of the block of partners that begins here, if one does and is not the first
  vec4 turning;
};

// What is taken of lists and items, and the dispatches over them.
struct BallWork {
  uint lists_used;     // words; may exceed the capacity: then the step is repeated with more
  uint items_used;     // likewise
  uint list_capacity;
  uint item_capacity;
  uint word_groups[3];    // over the words of all items
  uint tally_groups[3];   // over these and the particles
  uint item_groups[3];    // over items
  uint work_padding0, work_padding1, work_padding2;
};

// Triangles in a row that are passed over as one where they are far: face_block in src/model/ball_faces.h.
#define FACE_BLOCK 64u
// Pairs of a particle that are sorted by itself; with more, it asks all balls.
#define FACE_LIST_SIZE 32u
// Flags of a pair.
#define FACE_CONTACTS 1u  // there is one
#define FACE_WITHIN 2u   // its place is within the face, not on an edge

// A ball and the nearest face of a body.
struct BallFacePair {
  uint corner[3];  // particles
  uint flags;      // FACE_…
  float share[3];  // of the corners in the place
  float side;      // −1 where the face's normal, or e on an edge, leads away from the ball, else 1
  vec4 linear;     // normal towards the ball; w: distance [m]. Then what the ball receives: an impulse or a shift
  vec4 turning;
  uint next[3];    // in each corner's list: 3 · pair + corner + 1, or 0
  uint acts;       // 1: it does in this phase
};

// Pairs of a body that act in the phase; of a particle, where their list begins.
struct BallFaceCount {
  uint pairs;
  uint first_pair;
};

// A first contact and one of each other side of a body: at most so many sides may a body have.
#define CONTACT_SIDES 6u
#define CONTACT_RECORDS 6u
// Flags of a candidate group.
#define CONTACT_CLOSED 1u    // the triangles' body has an inside
#define CONTACT_OPPOSING 2u  // only faces that turn to the point count

// A point and triangles of one body near it, in src/gpu_solver/contact_lists.h.
struct CandidateGroup {
  uint carrier0, carrier1;  // particles that carry the point, twice the same of a particle's own
  uint flags;               // CONTACT_…
  uint near_first;          // triangles near it, in the words
  uint near_count;
  uint normals_first0, normals_count0;  // triangles at the carriers, likewise
  uint normals_first1, normals_count1;
  float carrier_weight0, carrier_weight1;
  float start_distance;  // d₀ in the initial state where they overlapped [m], else far above ρ
  float contact_stiffness;  // k [N/m]
  float contact_damping;    // c [N·s/m]
  float spacing;          // s [m]
  float reach;            // ρ [m]
  float depth;            // D [m]
  float eased_depth;      // the same while bodies are eased apart [m]
  float margin;           // by which boxes of candidates are widened [m]
  float tie;              // distances that differ by less are equal [m]
  float range;            // up to where contacts are found [m]: ρ, or more in implicit Euler
  float contact_friction;   // μ
};

// A contact.
struct ContactRecord {
  vec4 normal;   // n; w: normal force f [N]
  vec4 friction;  // on the point [N]; w: normal force without motion [N]
  uvec4 corner;  // particles; w: contacts of the candidate group, in its first record
  vec4 share;    // weights of the corners; w: unused
  vec4 answer;   // implicit Euler, at the trial: force on the point [N], then its matrix times a direction; w: along n [kg]
  vec4 turn;     // unit vector of a friction that slides; w: stiffness across n [kg]
};

// A particle that contacts may name: as a carrier of points, and as a corner.
struct ContactParticle {
  uint listed;       // which
  uint own_first;    // candidate groups of its points, in the words
  uint own_count;
  uint visit_first;  // candidate groups with triangles at it, likewise
  uint visit_count;
  uint contact_padding0, contact_padding1, contact_padding2;
};

// One stage of an explicit method, see src/model/integrator.h.
struct Stage {
  float advance;    // h · advance: from the start of the step to the next stage [s]
  float weight;     // small integer
  uint accumulate;  // 1: an earlier stage's slope is in the sums already
  uint last;        // 1: the step ends after this stage
};

struct Terrain {
  vec4 geometry[GEOMETRY_SIZE];  // xyz: vectors in the order of the shape's keys; w: numbers in theirs
  float mass;         // M [kg], if movable
  float restitution;  // e
  float friction;     // μ
  uint movable;       // 1: M is finite
  uint shape;         // row of the table in src/model/shapes/table.h
  uint motion;        // its place among the terrains that move, + 1; 0: it never moves
  uint padding0, padding1;
};

// Where a moving terrain is, and how fast: src/model/terrain.h.
struct Pose {
  vec4 offset;    // [m]; w: unused
  vec4 velocity;  // V [m/s]; w: unused
};

// A damped spring of rest length 0 to a fixed anchor, see include/aspic/inputs.h.
struct Pull {
  vec4 anchor;      // [m]; w: unused
  float stiffness;  // k [N/m]
  float damping;    // c [N·s/m]
  uint particle;    // balls count on after the particles
  uint pull_padding;
};

struct Control {
  uint bad_step;      // first step that diverged, or NO_STEP: later steps write nothing
  uint bad_particle;  // 2 · lowest particle that diverged in it, + 1 if its numbers are finite (too fast)
  uint full_step;     // first step whose contacts found no room, or NO_STEP: it has to be repeated with more
  uint overrun;       // KERNEL_… that had a loop of more than MAX_ROUNDS, or 0
  uint passes;        // items that counted themselves since the words were written: a device may drop some
  uint stale;         // 1: bodies have moved so far that lists of what is near them do not hold any more
  uint control_padding0, control_padding1;
};

// The state of implicit Euler's solve on the device, which decides by itself what the next dispatch does.
struct Solve {
  uint phase;        // PHASE_…
  uint step;         // steps ended since the state was loaded
  uint target_step;  // where to stop
  uint parity;       // 0: the state is in A, 1: in B
  uint bad_particle;  // as in Control, or BAD_RESIDUAL
  uint blocks_done;   // of the reduction under way
  uint first;         // accepted whatever it is: 1: the trial is v, the step's first; 2: v + h·g, taken in its place; 3: the
                      // end of the first solve
  uint use_trial;     // 1: v' is the trial, 0: the base
  uint newton;        // iterations in this step
  uint cg;            // iterations in this linear system
  uint cg_total;      // iterations in this step
  uint updates;       // times δ was updated in this linear system
  uint halvings;      // of Newton's step
  uint without_progress;  // Newton iterations without a smaller residual
  uint end;           // SolveEnd
  uint ticks;         // rounds of kernels in this step, or in the last if none is under way
  float lambda;       // fraction of δ under trial
  float merit;        // Σ |(v' − v) − h·a|² of the accepted iterate
  float residual;     // its largest component of |(v' − v) − h·a| [m/s]
  float best;         // smallest residual in this step
  float rz;           // r·z
  float enough;       // r·z at which the linear system counts as solved
  float alpha;
  float beta;
  uint last_newton;   // of the last ended step, for reports
  uint last_cg;
  float last_residual;
  uint last_end;
  uint ground;        // of the trial: 1: the ground holds a particle, 2: and prescribes a part of δ
  float worst_residual;  // since the state was loaded; counters wrap and are read as differences
  uint converged;
  uint stagnated;
  uint not_converged;
  uint newton_sum;
  uint cg_sum;
  float forcing;      // η of the linear system under way
  uint on_ground;     // 1: the ground held a particle at the accepted iterate or at a trial since
  uint prescribing;   // 1: the round under way takes the prescribed part of δ to the right-hand side
  uint full;          // 1: the balls' contacts found no room; their part of the step has to be repeated with more
  uint overrun;       // as in Control, or ITEMS_MISSING
  uint moved;         // items of the kernel direction that counted themselves in this step
  uint in_contact;      // 1: bodies are near each other in this step
  uint again;         // 1: the step's second solve, with what touches where the first one ended
  uint stale;         // as in Control: the step has to wait for other lists
  uint first_newton;  // iterations of the first solve
  uint solve_padding0, solve_padding1, solve_padding2;
};

#ifdef __cplusplus
struct Simulation {
#else
layout(std140, binding = BINDING_SIMULATION) uniform Simulation {
#endif
  vec4 gravity;               // g [m/s²]; w: |g|h, speed gained by a step of free fall [m/s]
  float contact_distance;     // ε [m]
  float resting_speed;        // max(v_s, 2|g|h) [m/s]
  float step_scale;           // h / divisor of the method [s]
  float divergence_speed_squared;  // [m²/s²]
  uint particle_count;
  uint spring_count;
  uint terrain_count;
  uint contact_model;         // CONTACT_…
  uint class_bits;            // low bits of a gather word that hold the spring class
  uint drift;                 // DRIFT_…: the velocity that moves positions
  uint max_newton;            // implicit Euler: src/model/implicit.h
  uint max_cg;
  float time_step;            // h [s]
  float tolerance;            // on the residual [m/s]
  float first_forcing;
  float forcing_factor;
  float least_forcing;
  float most_forcing;
  float progress_share;
  uint max_halvings;
  uint max_without_progress;
  float progress_share_on_ground;
  uint max_without_progress_on_ground;
  float least_turn;
  float least_wedge;
  uint ball_count;
  uint ball_spin;             // 1: friction makes balls rotate
  uint bucket_mask;           // buckets of the grid − 1
  float ball_restitution;     // e of balls and particles
  float ball_friction;        // μ of balls and particles
  float ball_cells_per_meter;  // of the grid
  uint mark_shift;            // a mark stands for 2^mark_shift blocks of particles
  vec4 resistance_constants;  // include/aspic/settings.h
  float set_speed;            // v_s [m/s]: contact.resting-speed
  uint simulation_padding0, simulation_padding1, simulation_padding2;
  Stage stages[MAX_STAGES];
  SpringClass spring_classes[MAX_SPRING_CLASSES];
  Terrain terrains[MAX_TERRAINS];
};
