// A large square of a plane around what the camera looks at.
#include "frame.glsl"
uniform vec4 plane_point;  // w: half its side [m]
uniform vec3 plane_normal;
out vec3 world;
out vec2 local;  // along the texture [m]

void main() {
  vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 2.0 - 1.0;
  vec3 n = plane_normal;
  vec3 across = abs(n.y) > 0.9999 ? vec3(0.0, 0.0, 1.0) : normalize(cross(n, vec3(0.0, 1.0, 0.0)));
  vec3 along = cross(n, across);
  world = plane_point.xyz + plane_point.w * (corner.x * along + corner.y * across);
  local = vec2(dot(world, along), dot(world, across));
  gl_Position = view_projection * vec4(world, 1.0);
}
