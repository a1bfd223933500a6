// One terrain by sight line and distance: surfaces are met from their free side, so that planes are glass from below and
// bowls show their far wall.
#include "render/layout.glsl"
#include "render/sight.glsl"
#include "render/drawn_terrain.glsl"
#include "render/pick.glsl"

layout(location = LOCATION_FIRST) uniform uint index;
in vec2 on_screen;
layout(location = 0) out uvec2 picked;

const float ground_share = 14.0;  // in distances of the target: as far as ground is drawn

// How far along the sight line the surface is met; −1: nowhere. No step is longer than the distance to the surface (Hart,
// Sphere Tracing, 1996). Newton's method brings the last steps to their end, which are short where the line only grazes.
float along(vec3 start, vec3 ray, float farthest) {
  float near = 1e-4 * eye.w;
  float t = 0.0;
  bool free = false;
  for (int i = 0; i < 128 && t <= farthest; ++i) {
    float d = distance_to(0u, start + t * ray);
    free = free || d > 2.0 * near;
    if (free && d < near) break;
    t += max(abs(d), near);
  }
  for (int i = 0; i < 4 && free; ++i) {
    vec4 g = gap(0u, start + t * ray);
    t += g.w / max(-dot(g.xyz, ray), 1e-4);
  }
  return free && abs(distance_to(0u, start + t * ray)) < 0.2 * near ? t : -1.0;
}

void main() {
  vec4 far = clip_to_world * vec4(on_screen, 1.0, 1.0);
  vec3 ray = -to_eye(far.xyz / far.w);
  vec3 start = eye.xyz;
  float farthest = ground_share * eye.w;
  if (viewer.w == 0.0) {
    vec4 near = clip_to_world * vec4(on_screen, -1.0, 1.0);
    start = near.xyz / near.w;
    farthest = 2.0 * ORTHOGRAPHIC_DISTANCE * eye.w;
  }
  float t = along(start, ray, farthest);
  if (t <= 0.0 || t > farthest) discard;
  vec3 hit = (view * vec4(start + t * ray, 1.0)).xyz;
  // A little behind itself, so that what rests on it lies before it.
  gl_FragDepth = depth_of(hit + 0.002 * (viewer.w > 0.0 ? hit : vec3(0.0, 0.0, -eye.w)));
  picked = uvec2(pick_word(PICK_TERRAIN, index), floatBitsToUint(-hit.z));
}
