// A ribbon along each spring that faces the eye, at least a pixel wide; where springs fade, with half a pixel more on
// either side.
#include "render/layout.glsl"
#include "render/sight.glsl"
#include "render/cut.glsl"
#include "render/spring_quantity.glsl"

layout(lines) in;
layout(triangle_strip, max_vertices = 4) out;
layout(location = LOCATION_RADIUS) uniform float radius;
layout(location = LOCATION_FADES) uniform int fades;
layout(location = LOCATION_SPRING) uniform vec4 spring;  // k, c, r, cord
in vec3 end_velocity[];
in float end_quantity[];
out float across;
out vec3 sideways;
out vec3 towards_eye;
out float shown;
out vec2 reach;  // half width, of the ribbon and of the spring itself [pixels]

void main() {
  vec3 xa = gl_in[0].gl_Position.xyz;
  vec3 xb = gl_in[1].gl_Position.xyz;
  vec3 e = xa - xb;
  if (e == vec3(0.0)) return;
  float own = chosen_of(
      spring_quantity(e, end_velocity[0] - end_velocity[1], spring.x, spring.y, spring.z, spring.w > 0.0));
  if (!cut_segment(xa, xb)) return;
  // What lies behind a filled section is not seen.
  if (section.y > 0.0 && max(dot(cut.xyz, xa), dot(cut.xyz, xb)) < section.x) return;
  vec3 a = (view * vec4(xa, 1.0)).xyz;
  vec3 b = (view * vec4(xb, 1.0)).xyz;
  // What lies behind the eye would turn the ribbon inside out.
  const float nearest = 0.02;
  if (a.z > -nearest && b.z > -nearest) return;
  if (a.z > -nearest) a = mix(b, a, (b.z + nearest) / (b.z - a.z));
  if (b.z > -nearest) b = mix(a, b, (a.z + nearest) / (a.z - b.z));
  for (int corner = 0; corner < 4; ++corner) {
    bool first = (corner & 1) == 0;
    vec3 end = first ? a : b;
    across = float((corner >> 1) * 2 - 1);
    towards_eye = -sight_of(end);
    vec3 side = cross(normalize(b - a), towards_eye);
    side = dot(side, side) > 0.0 ? normalize(side) : vec3(1.0, 0.0, 0.0);
    sideways = side;
    float value = color_mode == COLOR_SPEED ? end_quantity[first ? 0 : 1] : own;
    shown = (value - quantity_range.x) * quantity_range.y;
    float pixel = pixel_at(-end.z);
    float half_width = radius / pixel;
    reach = vec2(fades == 0 ? max(half_width, 0.6) : max(half_width, 0.5) + 0.5, half_width);
    gl_Position = projection * vec4(end + across * reach.x * pixel * side, 1.0);
    EmitVertex();
  }
  EndPrimitive();
}
