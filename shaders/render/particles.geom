// A square before each particle, on which the fragment shader finds the ball.
#include "render/layout.glsl"
#include "render/sight.glsl"
#include "render/cut.glsl"

layout(points) in;
layout(triangle_strip, max_vertices = 4) out;
layout(location = LOCATION_RADIUS) uniform float radius;
in float vertex_shown[];
in float vertex_pinned[];
out vec2 on_disc;
out vec3 center;
flat out float shown;
flat out float pinned;
flat out float size;

void main() {
  if (kept(gl_in[0].gl_Position.xyz) < 0.0) return;
  vec3 c = (view * vec4(gl_in[0].gl_Position.xyz, 1.0)).xyz;
  // Never smaller than a pixel and a half across.
  float pixel = pixel_at(-c.z);
  float r = max(radius, 0.75 * pixel);
  vec3 forward = sight_of(c);
  vec3 right = normalize(cross(forward, vec3(0.0, 1.0, 0.0)));
  vec3 up = cross(right, forward);
  for (int corner = 0; corner < 4; ++corner) {
    on_disc = 1.15 * vec2((corner & 1) * 2 - 1, (corner >> 1) * 2 - 1);
    center = c;
    shown = vertex_shown[0];
    pinned = vertex_pinned[0];
    size = r;
    gl_Position = projection * vec4(c + r * (on_disc.x * right + on_disc.y * up), 1.0);
    EmitVertex();
  }
  EndPrimitive();
}
