// The one list of buffer structs, binding numbers and limits, read by GLSL and by C++ (src/gpu_solver/layout.h).
// vec4 and uvec4 only, or scalars in groups of four: then std140, std430 and C++ agree on every offset.

#define MAX_STAGES 4
#define MAX_SPRING_CLASSES 256
#define MAX_TERRAINS 64

// Storage blocks.
#define BINDING_START_STATE 0   // Particle[]: the state the step began with, read only
#define BINDING_STAGE_STATE 1   // Particle[]: where this stage evaluates the force, read only
#define BINDING_OUT_STATE 2     // Particle[]: the next stage's state, or the step's end
#define BINDING_STAGE_SUMS 3    // Particle[]: weighted sums of the stages' slopes so far
#define BINDING_INCIDENT_START 4  // uint[particles + 1]: where each particle's list begins in the incident words
#define BINDING_INCIDENT 5      // uint[2 · springs]: gather: neighbour and class; per-spring: spring and side
#define BINDING_CONTROL 6       // Control
#define BINDING_SPRING_FORCES 7 // vec4[springs]: force on end a [N], signed spring strength s [N]
#define BINDING_SPRINGS 4       // uvec2[springs], in the per-spring force pass only
// Storage blocks of the implicit kernels, where they differ.
#define BINDING_STATE_A 0       // Particle[]: the state, or where the step's end goes: Solve.parity tells
#define BINDING_STATE_B 1       // Particle[]: the other one
#define BINDING_TRIAL 2         // vec4[particles]: v' at which the residual is evaluated [m/s]
#define BINDING_SEARCH 3        // vec4[particles]: conjugate gradients' search direction p [m/s]
#define BINDING_SOLVE 6         // Solve, then vec4[blocks]: the reductions' partial results
#define BINDING_OWN 7           // vec4[OWN_VECTORS · particles]: what only its own invocation touches
// Storage blocks of the ball kernels; particles are STATE_A and STATE_B: the step's start and its end.
#define BINDING_BALLS 2         // Ball[BALL_SLOTS · balls]
#define BINDING_BALL_BODIES 3   // BallBody[balls]
#define BINDING_BALL_COUNTS 4   // uint[balls + particles]: acting or overlapping pairs of each body
#define BINDING_BALL_GRID 5     // uint[2 · buckets + balls + particles]: heads of lists, then their links
// Uniform blocks.
#define BINDING_SIMULATION 0
#define BINDING_PULL 1

// Vectors of the OWN block, each an array over particles.
#define OWN_BASE 0u       // v' of the accepted Newton iterate [m/s]
#define OWN_DELTA 1u      // Newton's step δ [m/s]
#define OWN_RESIDUAL 2u   // r = right-hand side − A·δ [kg·m/s]
#define OWN_Z 3u          // preconditioned r [m/s]
#define OWN_PRODUCT 4u    // A·p [kg·m/s]
#define OWN_HELD 5u       // contact force held during the step [N]
#define OWN_INVERSE_A 6u  // inverse diagonal block: xx, yy, zz [1/kg]
#define OWN_INVERSE_B 7u  // xy, xz, yz [1/kg]
#define OWN_VECTORS 8u

// Elements of one block of a reduction, and the group size of every kernel that takes part in one (spec §2.9).
#define REDUCTION_BLOCK 256

// How a solve ended: SolveEnd in src/model/implicit.h.
#define SOLVE_CONVERGED 0u
#define SOLVE_STAGNATED 1u
#define SOLVE_NOT_CONVERGED 2u

#define PHASE_IDLE 0u      // all steps asked for are done
#define PHASE_BEGIN 1u     // a step begins
#define PHASE_EVALUATE 2u  // the residual at the trial is wanted
#define PHASE_CG 3u        // a linear system is being solved
#define PHASE_BALLS 6u     // the particles' step has ended, the balls' has not
#define PHASE_DONE 4u      // v' is found: the step can end
#define PHASE_HALTED 5u    // the step diverged: nothing moves any more

// Uniform locations.
#define LOCATION_STEP 0   // index of the step since the state was loaded
#define LOCATION_STAGE 1  // index of the stage within the step
#define LOCATION_BALL_PARITY 2  // explicit methods: slot of the balls' state at the start of the step
#define LOCATION_BALL_PHASE 3   // BALL_PHASE_…

// Ball slots: two that take turns as start and end of a step, and one between phases.
#define BALL_SLOTS 3u
#define BALL_SLOT_BETWEEN 2u

// Phases of a step in which balls meet others, in their order.
#define BALL_PHASE_BALLS 0u      // velocities, ball and ball
#define BALL_PHASE_PARTICLES 1u  // velocities, ball and particle
#define BALL_PHASE_POSITIONS 2u  // overlaps of either kind
#define BALL_PHASES 3u

#define NO_BODY 0xffffffffu

#define DRIFT_STAGE_VELOCITY 0u  // Drift in src/model/integrator.h
#define DRIFT_NEW_VELOCITY 1u
#define DRIFT_MEAN_VELOCITY 2u

#define SHAPE_PLANE 0u
#define SHAPE_SPHERE 1u
#define SHAPE_BOWL 2u

#define CONTACT_COULOMB 0u
#define CONTACT_COURSE 1u

#define NO_STEP 0xffffffffu

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

struct BallBody {
  float ball_mass;          // m [kg]
  float ball_inverse_mass;  // 1/m [1/kg]
  uint launch_step;         // first step it takes part in, counted since the state was loaded
  uint ball_padding;
};

// One stage of an explicit method, see src/model/integrator.h.
struct Stage {
  float advance;    // h · advance: from the start of the step to the next stage [s]
  float weight;     // small integer
  uint accumulate;  // 1: an earlier stage's slope stands in the sums already
  uint last;        // 1: the step ends after this stage
};

struct SpringClass {
  float stiffness;    // k [N/m]
  float damping;      // c [N·s/m]
  float rest_length;  // r [m]
  uint cord;          // 1: resists stretch only
};

struct Terrain {
  vec4 point;     // a point of the plane or the centre [m]; w: radius [m]
  vec4 normal;    // unit normal, planes only; w: unused
  float mass;         // M [kg], if movable
  float restitution;  // e
  float friction;     // μ
  uint movable;       // 1: M is finite
  uint shape;         // SHAPE_…
  uint padding0, padding1, padding2;
};

// A damped spring of rest length 0 to a fixed anchor, see src/model/pull.h.
struct Pull {
  vec4 anchor;      // [m]; w: unused
  float stiffness;  // k [N/m]
  float damping;    // c [N·s/m]
  uint particle;    // NO_BODY: nobody is pulled
  uint pull_padding;
};

struct Control {
  uint bad_step;      // first step that diverged, or NO_STEP: later steps write nothing
  uint bad_particle;  // 2 · lowest particle that diverged in it, + 1 if its numbers are finite (too fast)
  uint padding0, padding1;
};

// The state of implicit Euler's solve on the device, which decides by itself what the next dispatch does.
struct Solve {
  uint phase;        // PHASE_…
  uint step;         // steps ended since the state was loaded
  uint target_step;  // where to stop
  uint parity;       // 0: the state is in A, 1: in B
  uint bad_particle;  // as in Control
  uint blocks_done;   // of the reduction under way
  uint first;         // 1: the trial is the step's first and is accepted whatever it is
  uint use_trial;     // 1: v' is the trial, 0: the base
  uint newton;        // iterations in this step
  uint cg;            // iterations in this linear system
  uint cg_total;      // iterations in this step
  uint updates;       // times δ was updated in this linear system
  uint halvings;      // of Newton's step
  uint without_progress;  // Newton iterations without a smaller residual
  uint end;           // SolveEnd
  uint ticks;         // rounds of kernels in this step
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
  uint last_ticks;
  float worst_residual;  // since the state was loaded; counters wrap and are read as differences
  uint converged;
  uint stagnated;
  uint not_converged;
  uint newton_sum;
  uint cg_sum;
  float forcing;      // η of the linear system under way
};

#ifdef __cplusplus
struct Simulation {
#else
layout(std140, binding = BINDING_SIMULATION) uniform Simulation {
#endif
  vec4 gravity;               // g [m/s²]; w: |g|h, what a step of free fall gains [m/s]
  float epsilon;              // ε: m for distances, m/s for speeds
  float resting_speed;        // max(ε, 2|g|h) [m/s]
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
  uint ball_count;
  uint ball_spin;             // 1: friction makes balls rotate
  uint bucket_mask;           // buckets of the grid − 1
  float ball_restitution;     // e of balls and particles
  float ball_friction;        // μ of balls and particles
  float ball_cells_per_metre;      // cells of the grid of balls
  float particle_cells_per_metre;  // cells of the grid of particles
  Stage stages[MAX_STAGES];
  SpringClass spring_classes[MAX_SPRING_CLASSES];
  Terrain terrains[MAX_TERRAINS];
};
