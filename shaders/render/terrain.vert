// Planes as large squares, made of the unit square, and other surfaces as meshes. The shadowed variant of a plane covers
// only where a light's map falls on it.
#include "render/frame.glsl"
#ifdef SHADOWED_PLANE
#include "render/light.glsl"
layout(location = LOCATION_LIGHT) uniform int light;
#endif

layout(location = ATTRIBUTE_POSITION) in vec4 position;
#ifdef PLANE
layout(location = LOCATION_PLANE_POINT) uniform vec4 plane_point;    // middle of the square [m]; w: half its side [m]
layout(location = LOCATION_PLANE_NORMAL) uniform vec4 plane_normal;  // w: unused
#else
layout(location = ATTRIBUTE_NORMAL) in vec4 normal;
layout(location = LOCATION_OFFSET) uniform vec4 offset;
#endif
out vec3 world;
out vec3 local;  // planes: position along the texture [m]; else the normal

void main() {
#ifdef PLANE
  // Downhill first, so that the texture lies straight on a slope; along x where the plane is level.
  vec3 n = plane_normal.xyz;
  vec3 across = abs(n.y) > 0.9999 ? vec3(0.0, 0.0, 1.0) : normalize(cross(n, vec3(0.0, 1.0, 0.0)));
  vec3 along = cross(n, across);
#ifdef SHADOWED_PLANE
  mat3 to_light = mat3(lights[light]);
  vec4 center = light_boxes[light].center;
  vec3 start = (center.xyz + vec3(center.w * position.xy, 0.0)) * to_light;
  vec3 towards_light = vec3(0.0, 0.0, -1.0) * to_light;
  float slant = dot(n, towards_light);
  // A light that only grazes the plane, or comes from behind it, throws no shadow worth the name.
  world = slant < 0.05 ? plane_point.xyz : start - dot(n, start - plane_point.xyz) / slant * towards_light;
#else
  world = plane_point.xyz + plane_point.w * (position.x * along + position.y * across);
#endif
  local = vec3(dot(world, along), dot(world, across), 0.0);
#else
  local = normal.xyz;
  world = position.xyz + offset.xyz;
#endif
  gl_Position = view_projection * vec4(world, 1.0);
}
