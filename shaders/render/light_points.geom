#include "render/layout.glsl"
#include "render/light.glsl"

layout(points) in;
layout(triangle_strip, max_vertices = 4) out;
layout(location = LOCATION_LIGHT) uniform int light;
layout(location = LOCATION_RADIUS) uniform float radius;
out float depth;
out vec2 on_disc;
flat out float size;

void main() {
  // w: 1 for particles, its own radius for a ball, 0 while that waits.
  float r = radius * gl_in[0].gl_Position.w;
  if (r == 0.0) return;
  vec3 p = in_light(light, gl_in[0].gl_Position.xyz);
  for (int corner = 0; corner < 4; ++corner) {
    on_disc = vec2((corner & 1) * 2 - 1, (corner >> 1) * 2 - 1);
    depth = p.z;
    size = r;
    gl_Position = vec4(p.xy + on_disc * (r * light_boxes[light].depth.y), p.z / light_boxes[light].depth.x, 1.0);
    EmitVertex();
  }
  EndPrimitive();
}
