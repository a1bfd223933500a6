// The blocks and locations of drawing, read by GLSL and by C++ (src/render/layout.h).
// mat4, vec4 and scalars in groups of four only: then std140, std430 and C++ agree on every offset.
#include "shared/layout.glsl"

#define MAX_SHADOW_SPHERES 16

// Texture units.
#define UNIT_GROUND 0
#define UNIT_SUN_MAP 1
#define UNIT_SKY_MAP 2
#define UNIT_THICKNESS 3
#define UNIT_BEHIND 4
#define UNIT_COLOR_MAP 5
#define UNIT_GLYPHS 6
#define UNIT_FRAME 7
#define UNIT_SHADE 8

// Vertex attributes.
#define ATTRIBUTE_POSITION 0
#define ATTRIBUTE_VELOCITY 1
#define ATTRIBUTE_NORMAL 2
#define ATTRIBUTE_QUANTITY 3
#define ATTRIBUTE_TURN 4    // of balls: unit quaternion
#define ATTRIBUTE_COLOR 5  // of balls: linear light

// Storage of the kernels of meshes that follow particles, besides those of shared/layout.glsl.
#define BINDING_SKIN_CORNERS 1  // uvec4[2 · vertices]: particles at the corners of a vertex's cell
#define BINDING_SKIN_PLACES 2   // vec4[vertices]: where in the cell

// Uniforms outside blocks.
#define LOCATION_COUNT 0
#define LOCATION_CLASS_BITS 1      // of incident words, in the quantity kernel
#define LOCATION_LIGHT 0
#define LOCATION_BASE_COLOR 1
#define LOCATION_SPRING 2         // k, c, r, cord
#define LOCATION_RADIUS 3         // of spheres and springs [m]
#define LOCATION_PLANE_POINT 4
#define LOCATION_PLANE_NORMAL 5
#define LOCATION_SIDE 7
#define LOCATION_FADES 7          // of springs: 1 where those thinner than a pixel fade
#define LOCATION_FIRST 8          // of balls, particles or terrains: the first
#define LOCATION_ELAPSED 9        // since the image before [s]
#define LOCATION_ANCHOR 10        // of a pull [m]; w: 1 where it represents the particle
#define LOCATION_TERRAIN 12       // DrawnTerrain: its geometry, three vec4, and shape
#define LOCATION_OFFSET 6         // of terrain that moves [m]
#define LOCATION_LATTICE 16       // particles of a lattice along i, j and k
#define LOCATION_CELL 17          // of a lattice: the first of a run of cells
#define LOCATION_MARK 11          // MARK_…, least radius [pixels], opacity, whether to encode as sRGB

// An orthographic image's eye, in distances of the target: as far as is seen before the target, and behind it.
#define ORTHOGRAPHIC_DISTANCE 40.0f

// Lights that the bodies keep off: the sun, and the sky straight above.
#define LIGHT_SUN 0
#define LIGHT_SKY 1
#define LIGHTS 2

// Half sides of their maps, as shares of the extent they show, plus meters: room for penumbras, which are wider for
// the sky.
#define SUN_MAP_MARGIN 0.65
#define SKY_MAP_MARGIN 0.85
#define MAP_BORDER 0.05

// Marks on particles.
#define MARK_RING 0.0
#define MARK_PINNED 1.0   // only where a particle is pinned
#define MARK_DIAMOND 2.0
#define MARK_ANCHOR 3.0
#define MARK_LINE 4.0

// What the ID image shows: kinds, in the bits above the index.
#define PICK_PARTICLE 1u
#define PICK_BALL 2u
#define PICK_TERRAIN 3u
#define PICK_KIND_SHIFT 30

// Quantities that colors show, in the order of ViewColor.
#define COLOR_MATERIAL 0u
#define COLOR_TYPE 1u
#define COLOR_STRAIN 2u
#define COLOR_FORCE 3u
#define COLOR_SPEED 4u
#define COLOR_SIGNED_STRAIN 5u
#define COLOR_ENERGY 6u
#define COLOR_ACTUATION 7u

// Places in the list of extremes of what colors show: least and largest, as ordered() integers.
#define EXTREMES_BODIES 0
#define EXTREMES_SPRINGS 2
#define EXTREMES 4

// Light-space box of the particles; floats as unsigned integers in the same order, for atomicMin and atomicMax.
struct Bounds {
  uvec4 lower;
  uvec4 upper;
};

// A vertex of a body's surface.
struct SkinVertex {
  vec4 position;  // [m]; w: 1
  vec4 normal;    // unit; w: what colors show there
};

// The square map of a light, fitted to that box.
struct LightBox {
  vec4 center;  // in the light's space [m]; w: half side of the map [m]
  vec4 depth;   // half depth [m]; y: 1/half side [1/m]; z, w: unused
};

// Arguments of an indexed indirect draw, before the indices themselves.
struct SectionDraw {
  uint indices;
  uint instances;
  uint first_index;  // past this struct
  uint base_vertex;
  uint base_instance;
  uint padding0, padding1, padding2;
};

#ifdef __cplusplus
struct Frame {
#else
layout(std140, binding = BINDING_FRAME) uniform Frame {
#endif
  mat4 view;
  mat4 projection;
  mat4 view_projection;
  mat4 clip_to_world;
  mat4 lights[LIGHTS];        // rotations from the world to each light's space, +z away from the light
  vec4 eye;                   // [m]; w: distance from the camera's position to the target
  vec4 viewer;                // the eye and 1; of an orthographic image, the unit vector towards it and 0
  vec4 sun;                   // unit, towards the sun
  vec4 viewport;              // width, height, 1/width, 1/height [pixels]
  vec4 shadow_tint;           // light that the bodies let through
  vec4 quantity_range;        // lower end, 1/(upper − lower) of the color scale
  vec4 cut;                   // unit normal and offset [m] of the plane beyond which bodies are not drawn; none: 0, 0, 0, 1
  vec4 section;               // x: offset of the plane whose section of the bodies is filled [m]; y: 1 if it hides all springs behind it; z: 1 if it is their ground
  vec4 shadow_spheres[MAX_SHADOW_SPHERES];  // solid spheres of the terrain: center, radius
  uint shadow_sphere_count;
  uint color_mode;           // COLOR_…
  uint particle_count;
  float see_through;          // 0…1: how far bodies let their inside be seen
};
