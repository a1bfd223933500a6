// An arrow as a flat shaft and head in the image's plane, of the same width at any distance.
#include "render/layout.glsl"
#include "render/cut.glsl"

layout(points) in;
layout(triangle_strip, max_vertices = 7) out;
in vec4 vertex_along[];
in vec3 vertex_color[];
out float across;  // −1…1 over the shaft, and over the head
out vec3 own_color;

vec4 from = vec4(0.0);
vec4 to = vec4(0.0);

// A corner at a place between the ends, so many pixels aside.
void corner(float share, vec2 side, float at) {
  vec4 place = mix(from, to, share);
  across = at;
  own_color = vertex_color[0];
  gl_Position = vec4(place.xy + 2.0 * side * viewport.zw * place.w, place.zw);
  EmitVertex();
}

void main() {
  vec3 start = gl_in[0].gl_Position.xyz;
  if (kept(start) < 0.0) return;
  from = view_projection * vec4(start, 1.0);
  to = view_projection * vec4(start + vertex_along[0].xyz, 1.0);
  if (from.w <= 0.0 || to.w <= 0.0) return;
  vec2 way = 0.5 * (to.xy / to.w - from.xy / from.w) * viewport.xy;
  float size = length(way);
  if (size < 0.5) return;
  float width = max(1.0, viewport.y / 480.0);  // half that of the shaft [pixels]
  vec2 side = vec2(-way.y, way.x) / size;
  // Along the arrow shares are of clip space: those of the image are divided by w.
  float head = vertex_along[0].w * min(7.0 * width, 0.6 * size) / size;
  float neck = (1.0 - head) * from.w / (head * to.w + (1.0 - head) * from.w);
  corner(0.0, side * width, 1.0);
  corner(0.0, -side * width, -1.0);
  corner(neck, side * width, 1.0);
  corner(neck, -side * width, -1.0);
  EndPrimitive();
  if (vertex_along[0].w == 0.0) return;
  float wing = min(3.2 * width, 0.3 * size);
  corner(neck, side * wing, 1.0);
  corner(neck, -side * wing, -1.0);
  corner(1.0, vec2(0.0), 0.0);
  EndPrimitive();
}
