// A square around the outline of each launched ball as the eye sees it.
#include "render/layout.glsl"
#include "render/sight.glsl"

layout(points) in;
layout(triangle_strip, max_vertices = 4) out;
in vec4 vertex_turn[];
in vec3 vertex_color[];
in float vertex_shown[];
out vec3 on_square;
flat out vec3 center;
flat out float size;
flat out vec4 turn;
flat out vec3 own_color;
flat out float shown;

void main() {
  vec3 c = (view * vec4(gl_in[0].gl_Position.xyz, 1.0)).xyz;
  float away = length(c);
  // Never smaller than a pixel and a half across.
  float pixel = pixel_at(-c.z);
  float r = gl_in[0].gl_Position.w;
  if (r == 0.0 || away <= 1.001 * r) return;
  r = max(r, 0.75 * pixel);
  // The outline in the plane through the center, and a pixel around it.
  float outline = r * away / sqrt(max(away * away - r * r, 1e-6 * away * away)) + 2.0 * max(pixel, 0.0);
  vec3 forward = sight_of(c);
  vec3 right = normalize(cross(forward, abs(forward.y) > 0.99 ? vec3(1.0, 0.0, 0.0) : vec3(0.0, 1.0, 0.0)));
  vec3 up = cross(right, forward);
  for (int corner = 0; corner < 4; ++corner) {
    vec2 at = vec2((corner & 1) * 2 - 1, (corner >> 1) * 2 - 1);
    on_square = c + outline * (at.x * right + at.y * up);
    center = c;
    size = r;
    turn = vertex_turn[0];
    own_color = vertex_color[0];
    shown = vertex_shown[0];
    gl_PrimitiveID = gl_PrimitiveIDIn;
    gl_Position = projection * vec4(on_square, 1.0);
    EmitVertex();
  }
  EndPrimitive();
}
