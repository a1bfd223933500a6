// The terrain under drawing, with its distance and normal by the solvers' formulas in the device's own arithmetic.
struct DrawnTerrain {
  vec4 geometry[3];  // as Terrain of compute/layout.glsl
  uint shape;
};
layout(location = LOCATION_TERRAIN) uniform DrawnTerrain terrains[1];

float dot3(vec3 a, vec3 b) { return dot(a, b); }
float norm3(vec3 a) { return length(a); }
float exact_div(float a, float b) { return a / b; }
float exact_sqrt(float a) { return sqrt(a); }
#include "shapes/all.glsl"
