#include "render/layout.glsl"
#include "render/sight.glsl"
#include "render/pick.glsl"

in vec3 on_square;
flat in vec3 center;
flat in float size;
layout(location = 0) out uvec2 picked;

void main() {
  vec3 ray = sight_of(on_square);
  vec3 start = vec3((1.0 - viewer.w) * on_square.xy, 0.0);
  float along = dot(center - start, ray);
  float beside = length(start + along * ray - center);
  if (beside > size) discard;
  vec3 hit = start + (along - sqrt(size * size - beside * beside)) * ray;
  gl_FragDepth = depth_of(hit);
  picked = uvec2(pick_word(PICK_BALL, uint(gl_PrimitiveID)), floatBitsToUint(-hit.z));
}
