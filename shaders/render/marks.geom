// A square before a particle, or before a pull's anchor, that a mark is drawn on.
#include "render/layout.glsl"
#include "render/sight.glsl"
#include "render/cut.glsl"

layout(points) in;
layout(triangle_strip, max_vertices = 4) out;
layout(location = LOCATION_RADIUS) uniform float radius;
layout(location = LOCATION_ANCHOR) uniform vec4 anchor;
layout(location = LOCATION_MARK) uniform vec4 mark;
in float vertex_shown[];
in float vertex_pinned[];
out vec2 at;           // −1…1 across the mark, a pixel more around it
flat out float pixel;  // of the mark's radius

void main() {
  if (mark.x == MARK_PINNED && kept(gl_in[0].gl_Position.xyz) < 0.0) return;
  if (mark.x == MARK_PINNED && vertex_pinned[0] == 0.0) return;
  vec3 center = (view * vec4(mix(gl_in[0].gl_Position.xyz, anchor.xyz, anchor.w), 1.0)).xyz;
  float meters = pixel_at(-center.z);  // of a pixel
  if (meters <= 0.0) return;
  float r = max(radius, mark.y * meters);
  vec4 clip = projection * vec4(center, 1.0);
  // In front of the particle's ball.
  vec4 before = projection * vec4(center * (1.0 - min(1.5 * r / length(center), 0.5)), 1.0);
  for (int corner = 0; corner < 4; ++corner) {
    at = (1.0 + meters / r) * vec2((corner & 1) * 2 - 1, (corner >> 1) * 2 - 1);
    pixel = meters / r;
    gl_Position = vec4(clip.xy + r * vec2(projection[0][0], projection[1][1]) * at, before.z / before.w * clip.w, clip.w);
    EmitVertex();
  }
  EndPrimitive();
}
