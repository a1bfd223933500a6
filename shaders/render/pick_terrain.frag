// One terrain by sight line and distance: surfaces are met from their free side, so that planes are glass from below and
// bowls show their far wall.
#include "render/layout.glsl"
#include "render/drawn_terrain.glsl"
#include "render/pick.glsl"

layout(location = LOCATION_FIRST) uniform uint index;
in vec2 on_screen;
layout(location = 0) out uvec2 picked;

const float farthest = 14.0;  // in distances of the target: as far as ground is drawn

// How far along the sight line the surface is met; −1: nowhere. No step is longer than the distance to the surface (Hart,
// Sphere Tracing, 1996). Newton's method brings the last steps to their end, which are short where the line only grazes.
float along(vec3 ray) {
  float near = 1e-4 * eye.w;
  float t = 0.0;
  bool free = false;
  for (int i = 0; i < 128 && t <= farthest * eye.w; ++i) {
    float d = distance_to(0u, eye.xyz + t * ray);
    free = free || d > 2.0 * near;
    if (free && d < near) break;
    t += max(abs(d), near);
  }
  for (int i = 0; i < 4 && free; ++i) {
    vec4 g = gap(0u, eye.xyz + t * ray);
    t += g.w / max(-dot(g.xyz, ray), 1e-4);
  }
  return free && abs(distance_to(0u, eye.xyz + t * ray)) < 0.2 * near ? t : -1.0;
}

void main() {
  vec4 far = clip_to_world * vec4(on_screen, 1.0, 1.0);
  vec3 ray = normalize(far.xyz / far.w - eye.xyz);
  float t = along(ray);
  if (t <= 0.0 || t > farthest * eye.w) discard;
  vec3 hit = mat3(view) * (t * ray);
  // A little behind itself, so that what rests on it lies before it.
  gl_FragDepth = depth_of(1.002 * hit);
  picked = uvec2(pick_word(PICK_TERRAIN, index), floatBitsToUint(-hit.z));
}
