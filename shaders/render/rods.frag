// Rods: painted metal.
#include "render/frame.glsl"
#include "render/sight.glsl"

layout(location = LOCATION_BASE_COLOR) uniform vec4 base_color;
in vec3 world;
in vec3 surface_normal;
layout(location = 0) out vec4 color;

void main() {
  vec3 n = normalize(surface_normal);
  vec3 v = to_eye(world);
  float nl = max(dot(n, sun.xyz), 0.0);
  vec3 light = base_color.rgb * (0.46 * sun_light * nl * sphere_shade(world) + 0.80 * ambient(n));
  light += sun_light * 0.04 * highlight(n, v, sun.xyz, 0.3) + 0.3 * fresnel(dot(n, v), 0.04) * sky(reflect(-v, n));
  color = vec4(to_display(light), 1.0);
}
