// The wall of a bowl: its far side before the bodies, its near side over them.
#include "frame.glsl"
#include "shadow.glsl"
uniform int near_side;
in vec3 world;
in vec3 surface_normal;
out vec4 color;

float lines(float coordinate, float step_size, float width) {
  float off = abs(fract(coordinate / step_size + 0.5) - 0.5) * step_size;
  return (1.0 - smoothstep(0.6 * width, 1.6 * width, off)) * clamp(1.0 - 8.0 * width / step_size, 0.0, 1.0);
}

void main() {
  vec3 n = normalize(surface_normal), v = to_eye(world);
  float latitude = degrees(asin(clamp(n.y, -1.0, 1.0))), meridian = degrees(atan(n.z, n.x));
  float turn = min(fwidth(meridian), fwidth(meridian < 0.0 ? meridian + 360.0 : meridian));
  float grid = max(lines(latitude, 15.0, fwidth(latitude)), lines(meridian, 15.0, turn) * smoothstep(88.0, 70.0, abs(latitude)));
  float mirror = fresnel(abs(dot(n, v)), 0.04);
  vec3 reflected = sky(reflect(-v, near_side == 1 ? n : -n));
  if (near_side == 1) {
    float shine = 0.25 * highlight(n, v, sun.xyz, 0.18);
    vec3 light = mix(vec3(0.75, 0.9, 0.92), reflected, 0.6);
    color = vec4(to_display(light + sun_light * shine), clamp(clamp(0.02 + 0.75 * mirror + 0.06 * grid, 0.0, 0.85) + shine, 0.0, 1.0));
    return;
  }
  vec3 sunlit = sun_light * mix(vec3(1.0), sunlight_at(world), 0.9) * (0.25 + 0.35 * max(-n.y, 0.0));
  vec3 light = vec3(0.42, 0.60, 0.64) * (0.6 * sunlit + 0.55 * ambient(-n) * skylight_at(world)) + 0.35 * grid * vec3(0.9, 1.0, 1.0);
  light = mix(light, reflected, 0.35 * mirror);
  color = vec4(to_display(light), clamp(0.10 + 0.38 * smoothstep(0.9, -0.6, n.y) + 0.35 * mirror + 0.25 * grid, 0.0, 0.9));
}
