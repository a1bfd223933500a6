// A band from a particle to the anchor it is pulled to.
#include "render/layout.glsl"

layout(points) in;
layout(triangle_strip, max_vertices = 4) out;
layout(location = LOCATION_ANCHOR) uniform vec4 anchor;
layout(location = LOCATION_MARK) uniform vec4 mark;
in float vertex_shown[];
in float vertex_pinned[];
out vec2 at;
flat out float pixel;

void main() {
  vec3 a = (view * vec4(gl_in[0].gl_Position.xyz, 1.0)).xyz;
  vec3 b = (view * vec4(anchor.xyz, 1.0)).xyz;
  const float nearest = 0.02;
  if (a.z > -nearest && b.z > -nearest) return;
  if (a.z > -nearest) a = mix(b, a, (b.z + nearest) / (b.z - a.z));
  if (b.z > -nearest) b = mix(a, b, (a.z + nearest) / (a.z - b.z));
  vec4 from = projection * vec4(a, 1.0);
  vec4 to = projection * vec4(b, 1.0);
  vec2 along = (to.xy / to.w - from.xy / from.w) * viewport.xy;
  if (length(along) == 0.0) return;
  along = normalize(along);
  pixel = 1.0 / mark.y;
  float wide = 1.0 + pixel;
  for (int corner = 0; corner < 4; ++corner) {
    vec4 end = (corner & 1) == 0 ? from : to;
    float side = float((corner >> 1) * 2 - 1) * wide;
    at = vec2(side, 0.0);
    gl_Position = vec4(end.xy + 2.0 * side * mark.y * viewport.zw * vec2(-along.y, along.x) * end.w, end.zw);
    EmitVertex();
  }
  EndPrimitive();
}
