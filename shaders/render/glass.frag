// A bowl: a glass ball seen from outside (LOCATION_SIDE 0, blended over its content) or its far wall (1), whose inside
// also catches the shadows of what it holds.
#include "render/frame.glsl"
#include "render/sight.glsl"
#include "render/shadow.glsl"

layout(location = LOCATION_SIDE) uniform int side;
in vec3 world;
in vec3 local;
layout(location = 0) out vec4 color;

// Thin lines every `step_size` of a coordinate, as wide as a pixel or two at any distance; none where they crowd.
float lines(float coordinate, float step_size, float width) {
  float off = abs(fract(coordinate / step_size + 0.5) - 0.5) * step_size;
  return (1.0 - smoothstep(0.6 * width, 1.6 * width, off)) * clamp(1.0 - 8.0 * width / step_size, 0.0, 1.0);
}

void main() {
  vec3 n = normalize(local);
  vec3 v = to_eye(world);
  float nv = abs(dot(n, v));
  float latitude = degrees(asin(clamp(n.y, -1.0, 1.0)));
  float meridian = degrees(atan(n.z, n.x));
  // The meridian jumps from 180° to −180°; its turn by half a circle jumps elsewhere.
  float turn = min(fwidth(meridian), fwidth(meridian < 0.0 ? meridian + 360.0 : meridian));
  float grid = max(lines(latitude, 15.0, fwidth(latitude)),
                   lines(meridian, 15.0, turn) * smoothstep(88.0, 70.0, abs(latitude)));
  float low = smoothstep(0.9, -0.6, n.y);
  float mirror = fresnel(nv, 0.04);
  vec3 facing = side == 0 ? n : -n;
  vec3 reflected = sky(reflect(-v, facing));
  if (side == 0) {
    float alpha = clamp(0.02 + 0.75 * mirror + 0.06 * grid, 0.0, 0.85);
    vec3 light = mix(vec3(0.75, 0.9, 0.92), reflected, 0.6);
    float shine = 0.25 * highlight(n, v, sun.xyz, 0.18);
    color = vec4(to_display(light + sun_light * shine), clamp(alpha + shine, 0.0, 1.0));
    return;
  }
  vec3 sunlit = sun_light * mix(vec3(1.0), sunlight_at(world), 0.9) * (0.25 + 0.35 * max(-n.y, 0.0));
  float open = skylight_at(world);
  vec3 wall = vec3(0.42, 0.60, 0.64);
  vec3 light = wall * (0.6 * sunlit + 0.55 * ambient(-n) * open) + 0.35 * grid * vec3(0.9, 1.0, 1.0);
  light = mix(light, reflected, 0.35 * mirror);
  float alpha = clamp(0.10 + 0.38 * low + 0.35 * mirror + 0.25 * grid, 0.0, 0.9);
  color = vec4(to_display(light), alpha);
}
