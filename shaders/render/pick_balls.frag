#include "render/layout.glsl"
#include "render/pick.glsl"

in vec3 on_square;
flat in vec3 centre;
flat in float size;
layout(location = 0) out uvec2 picked;

void main() {
  vec3 ray = normalize(on_square);
  float along = dot(centre, ray);
  float beside = length(along * ray - centre);
  if (beside > size) discard;
  vec3 hit = (along - sqrt(size * size - beside * beside)) * ray;
  gl_FragDepth = depth_of(hit);
  picked = uvec2(pick_word(PICK_BALL, uint(gl_PrimitiveID)), floatBitsToUint(-hit.z));
}
