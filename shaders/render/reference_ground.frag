// A ground that is drawn only, half transparent: lines a meter apart, stronger every five, and the shadows that fall on
// it. It is drawn before bodies and over them, so that what lies below is seen through it.
#include "render/frame.glsl"
#include "render/shadow.glsl"

layout(location = LOCATION_PLANE_POINT) uniform vec4 plane_point;
in vec3 world;
in vec3 local;
layout(location = 0) out vec4 color;

// Lines every `step_size` [m], as wide as a pixel or `width` [m]; none where they crowd.
float lines(float step_size, float width) {
  vec2 pixel = fwidth(local.xy);
  vec2 off = abs(fract(local.xy / step_size + 0.5) - 0.5) * step_size;
  vec2 half_width = max(vec2(0.5 * width), 0.5 * pixel);
  vec2 cover = clamp((half_width - off) / pixel + 0.5, 0.0, 1.0) * min(width / pixel, vec2(1.0));
  cover *= clamp(1.5 - 4.0 * pixel / step_size, 0.0, 1.0);
  return max(cover.x, cover.y);
}

void main() {
  vec2 off = (world - plane_point.xyz).xz / plane_point.w;
  float near = 1.0 - smoothstep(0.05, 0.35, length(off));
  float sunny = dot(sunlight_at(world), vec3(1.0 / 3.0)) * 0.75 + 0.25 * skylight_at(world);
  float line = max(0.55 * lines(1.0, 0.02), 0.85 * lines(5.0, 0.05));
  vec3 light = mix(vec3(0.50, 0.54, 0.58), vec3(0.16, 0.22, 0.30), line) * (0.25 + 0.75 * sunny);
  float cover = mix(0.22 + 0.40 * (1.0 - sunny), 0.60, line);
  color = vec4(light, cover * near);
}
