// Cloth, lit from both sides: shaders/render/sheet.frag.
#include "frame.glsl"
uniform vec3 base_color;
in vec3 world;
in vec3 surface_normal;
in float shown;
out vec4 color;

void main() {
  vec3 n = normalize(surface_normal), v = to_eye(world);
  if (!gl_FrontFacing) n = -n;
  vec3 base = mapped == 1 ? on_scale(shown) : base_color;
  float nl = dot(n, sun.xyz), rim = 1.0 - max(dot(n, v), 0.0);
  vec3 lit = vec3(clamp((nl + 0.15) / 1.15, 0.0, 1.0)) + 0.35 * clamp(-nl, 0.0, 1.0) * base;
  vec3 light = base * (0.42 * sun_light * lit * sphere_shade(world) + 0.70 * ambient(n));
  light += 0.10 * rim * rim * rim * mix(base, vec3(1.0), 0.4) * ambient(n);
  color = vec4(to_display(light), 1.0 - 0.5 * see_through);
}
