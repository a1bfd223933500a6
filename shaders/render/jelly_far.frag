// The far walls of a translucent body, seen from inside through its flesh: they catch light at their edges.
#include "render/frame.glsl"
#include "render/sight.glsl"

layout(location = LOCATION_BASE_COLOR) uniform vec4 base_color;
in vec3 world;
in vec3 surface_normal;
in float shown;
layout(location = 0) out vec4 color;

void main() {
  vec3 n = -normalize(surface_normal);
  vec3 v = to_eye(world);
  float edge = 1.0 - max(dot(n, v), 0.0);
  float lit = clamp(0.5 - 0.5 * dot(n, sun.xyz), 0.0, 1.0);
  vec3 base = color_mode >= COLOR_STRAIN ? vec3(0.5) : base_color.rgb;
  vec3 light = mix(base, vec3(1.0), 0.3) * (0.25 * ambient(n) + 0.55 * sun_light * lit * lit);
  color = vec4(to_display(light), (0.35 + 0.55 * edge * edge) * (1.0 - 0.6 * see_through));
}
