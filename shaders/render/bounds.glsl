// The boxes of all that is drawn, in each light's space.
#include "render/ordered.glsl"

layout(std430, binding = BINDING_BOUNDS) restrict buffer BoundsBlock { Bounds bounds[LIGHTS]; };

// Makes a light's box hold these corners too, of floats that are ordered().
void widen(int light, uvec3 lower, uvec3 upper) {
  atomicMin(bounds[light].lower.x, lower.x);
  atomicMin(bounds[light].lower.y, lower.y);
  atomicMin(bounds[light].lower.z, lower.z);
  atomicMax(bounds[light].upper.x, upper.x);
  atomicMax(bounds[light].upper.y, upper.y);
  atomicMax(bounds[light].upper.z, upper.z);
}
