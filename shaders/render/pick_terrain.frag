// One terrain by sight line and formula: planes from their free side, balls from outside, the far wall of bowls.
#include "render/layout.glsl"
#include "render/pick.glsl"

layout(location = LOCATION_FIRST) uniform uint index;
layout(location = LOCATION_SIDE) uniform int shape;  // 0 plane, 1 sphere, 2 bowl
layout(location = LOCATION_PLANE_NORMAL) uniform vec4 plane_normal;
layout(location = LOCATION_SPHERE) uniform vec4 sphere;  // of a plane: a point of it; else centre, radius
in vec2 on_screen;
layout(location = 0) out uvec2 picked;

const float farthest = 14.0;  // in distances of the target: as far as ground is drawn

float along(vec3 ray) {
  vec3 from = eye.xyz - sphere.xyz;
  if (shape == 0) {
    float above = dot(plane_normal.xyz, from);
    float falling = -dot(plane_normal.xyz, ray);
    return above > 0.0 && falling > 0.0 ? above / falling : -1.0;
  }
  float middle = -dot(from, ray);
  vec3 beside = from + middle * ray;
  float half_chord = sphere.w * sphere.w - dot(beside, beside);
  if (half_chord < 0.0) return -1.0;
  half_chord = sqrt(half_chord);
  return shape == 1 ? middle - half_chord : middle + half_chord;
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
