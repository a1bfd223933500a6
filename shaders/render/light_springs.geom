// Springs into a light map, as ribbons that face the light.
#include "render/layout.glsl"
#include "render/light.glsl"
#include "render/cut.glsl"

layout(lines) in;
layout(triangle_strip, max_vertices = 4) out;
layout(location = LOCATION_LIGHT) uniform int light;
layout(location = LOCATION_RADIUS) uniform float radius;
out float depth;
out vec2 on_disc;
flat out float size;

void main() {
  vec3 xa = gl_in[0].gl_Position.xyz;
  vec3 xb = gl_in[1].gl_Position.xyz;
  if (!cut_segment(xa, xb)) return;
  vec3 a = in_light(light, xa);
  vec3 b = in_light(light, xb);
  vec2 along = b.xy - a.xy;
  float long_way = length(along);
  if (long_way == 0.0) return;
  vec2 side = vec2(-along.y, along.x) / long_way * (radius * light_boxes[light].depth.y);
  for (int corner = 0; corner < 4; ++corner) {
    vec3 end = (corner & 1) == 0 ? a : b;
    on_disc = vec2(0.0);
    depth = end.z;
    size = 0.0;
    gl_Position = vec4(end.xy + ((corner >> 1) == 0 ? -side : side), end.z / light_boxes[light].depth.x, 1.0);
    EmitVertex();
  }
  EndPrimitive();
}
