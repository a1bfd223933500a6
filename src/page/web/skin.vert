// A vertex of a skin is a particle, whose neighbors along the patch say its normal, or a mesh's own. LIGHT: as a light sees it.
#include "frame.glsl"
#include "particles.glsl"
#ifdef LIGHT
#include "lights.glsl"
uniform int light;
out float depth;
#endif
layout(location = 0) in uint self;
layout(location = 1) in uvec4 neighbors;
out vec3 world;
out vec3 surface_normal;
out float shown;
out vec3 from_eye;

void main() {
  vec4 p = particle(self);
  world = p.xyz;
  shown = p.w;
  if (neighbors.w == 0xffffffffu) surface_normal = particle(neighbors.x).xyz;
  else surface_normal = cross(particle(neighbors.x).xyz - particle(neighbors.y).xyz,
                              particle(neighbors.z).xyz - particle(neighbors.w).xyz);
  from_eye = viewer.w > 0.0 ? world - eye.xyz : dot(world - eye.xyz, viewer.xyz) * viewer.xyz;
#ifdef LIGHT
  vec3 q = in_light(light, world);
  depth = q.z;
  gl_Position = vec4(q.xy, q.z / lights[light].depth, 1.0);
#else
  gl_Position = view_projection * vec4(world, 1.0);
#endif
}
