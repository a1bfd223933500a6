#include "render/layout.glsl"
#include "render/pick.glsl"

layout(location = LOCATION_FIRST) uniform uint first_particle;
layout(location = LOCATION_RADIUS) uniform float radius;
in vec2 on_disc;
flat in vec3 center;
flat in float size;
layout(location = 0) out uvec2 picked;

void main() {
  if (dot(on_disc, on_disc) > 1.0) discard;
  // In front of the ball that is drawn, so that a surface the particle lies in does not hide it.
  gl_FragDepth = depth_of(center * max(1.0 - radius / length(center), 0.5));
  picked = uvec2(pick_word(PICK_PARTICLE, first_particle + uint(gl_PrimitiveID)), floatBitsToUint(-center.z));
}
