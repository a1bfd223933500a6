// LIGHT: as a light sees it.
#include "frame.glsl"
#ifdef LIGHT
#include "lights.glsl"
uniform int light;
out float depth;
#endif
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
uniform vec3 offset;
out vec3 world;
out vec3 surface_normal;

void main() {
  world = position + offset;
  surface_normal = normal;
#ifdef LIGHT
  vec3 q = in_light(light, world);
  depth = q.z;
  gl_Position = vec4(q.xy, q.z / lights[light].depth, 1.0);
#else
  gl_Position = view_projection * vec4(world, 1.0);
#endif
}
