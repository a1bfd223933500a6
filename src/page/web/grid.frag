// A ground that is drawn only (view.ground): lines every meter, stronger every five, and shadows.
#include "frame.glsl"
#include "shadow.glsl"
uniform vec4 plane_point;
in vec3 world;
in vec2 local;
out vec4 color;

float lines(float step_size, float width) {
  vec2 pixel = fwidth(local);
  vec2 off = abs(fract(local / step_size + 0.5) - 0.5) * step_size;
  vec2 half_width = max(vec2(0.5 * width), 0.5 * pixel);
  vec2 cover = clamp((half_width - off) / pixel + 0.5, 0.0, 1.0) * min(width / pixel, vec2(1.0));
  cover *= clamp(1.5 - 4.0 * pixel / step_size, 0.0, 1.0);
  return max(cover.x, cover.y);
}

void main() {
  float near = 1.0 - smoothstep(0.05, 0.35, length((world - plane_point.xyz).xz / plane_point.w));
  float sunny = dot(sunlight_at(world), vec3(1.0 / 3.0)) * 0.75 + 0.25 * skylight_at(world);
  float line = max(0.55 * lines(1.0, 0.02), 0.85 * lines(5.0, 0.05));
  vec3 light = mix(vec3(0.50, 0.54, 0.58), vec3(0.16, 0.22, 0.30), line) * (0.25 + 0.75 * sunny);
  color = vec4(light, mix(0.22 + 0.40 * (1.0 - sunny), 0.60, line) * near);
}
