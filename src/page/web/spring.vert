// A ribbon along each spring that faces the eye, at least a pixel wide.
#include "frame.glsl"
#include "particles.glsl"
layout(location = 0) in uvec2 ends;
layout(location = 1) in float value;
uniform float radius;
uniform int fades;       // 1: thinner than a pixel it covers as much as its own width does
uniform int from_ends;   // 1: colors show what the particles at the ends have
out float across;
out vec3 sideways;
out vec3 towards_eye;
out float shown;
out vec2 reach;  // half width, of the ribbon and of the spring itself [pixels]

void main() {
  bool first = (gl_VertexID & 1) == 0;
  vec4 pa = particle(ends.x), pb = particle(ends.y);
  vec3 a = (view * vec4(pa.xyz, 1.0)).xyz, b = (view * vec4(pb.xyz, 1.0)).xyz;
  const float nearest = 0.02;
  gl_Position = vec4(0.0);
  if ((a.z > -nearest && b.z > -nearest) || a == b) return;
  if (a.z > -nearest) a = mix(b, a, (b.z + nearest) / (b.z - a.z));
  if (b.z > -nearest) b = mix(a, b, (a.z + nearest) / (a.z - b.z));
  vec3 end = first ? a : b;
  across = float((gl_VertexID >> 1) * 2 - 1);
  towards_eye = -normalize(vec3(viewer.w * end.xy, end.z));
  vec3 side = cross(normalize(b - a), towards_eye);
  side = dot(side, side) > 0.0 ? normalize(side) : vec3(1.0, 0.0, 0.0);
  sideways = side;
  shown = from_ends == 1 ? (first ? pa.w : pb.w) : value;
  float pixel = (viewer.w > 0.0 ? -end.z : 1.0) * 2.0 / (projection[1][1] * viewport.y);
  float half_width = radius / pixel;
  reach = vec2(fades == 0 ? max(half_width, 0.6) : max(half_width, 0.5) + 0.5, half_width);
  gl_Position = projection * vec4(end + across * reach.x * pixel * side, 1.0);
}
