// Painted metal: shaders/render/rods.frag.
#include "frame.glsl"
uniform vec3 base_color;
in vec3 world;
in vec3 surface_normal;
out vec4 color;

void main() {
  vec3 n = normalize(surface_normal), v = to_eye(world);
  float nl = max(dot(n, sun.xyz), 0.0);
  vec3 light = base_color * (0.46 * sun_light * nl * sphere_shade(world) + 0.80 * ambient(n));
  light += sun_light * 0.04 * highlight(n, v, sun.xyz, 0.3) + 0.3 * fresnel(dot(n, v), 0.04) * sky(reflect(-v, n));
  color = vec4(to_display(light), 1.0);
}
