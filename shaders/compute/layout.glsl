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
// Uniform blocks.
#define BINDING_SIMULATION 0

// Uniform locations.
#define LOCATION_STEP 0   // index of the step since the state was loaded
#define LOCATION_STAGE 1  // index of the stage within the step

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

struct Control {
  uint bad_step;      // first step that diverged, or NO_STEP: later steps write nothing
  uint bad_particle;  // 2 · lowest particle that diverged in it, + 1 if its numbers are finite (too fast)
  uint padding0, padding1;
};

#ifdef __cplusplus
struct Simulation {
#else
layout(std140, binding = BINDING_SIMULATION) uniform Simulation {
#endif
  vec4 gravity;               // g [m/s²]; w: unused
  float epsilon;              // ε: m for distances, m/s for speeds
  float resting_speed;        // max(ε, 2|g|h) [m/s]
  float step_scale;           // h / divisor of the method [s]
  float divergence_speed_squared;  // [m²/s²]
  uint particle_count;
  uint spring_count;
  uint terrain_count;
  uint contact_model;         // CONTACT_…
  uint class_bits;            // low bits of a gather word that hold the spring class
  uint position_from_new_velocity;  // 1: symplectic Euler
  uint simulation_padding0, simulation_padding1;
  Stage stages[MAX_STAGES];
  SpringClass spring_classes[MAX_SPRING_CLASSES];
  Terrain terrains[MAX_TERRAINS];
};
