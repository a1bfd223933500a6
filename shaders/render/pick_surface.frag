// The particle that is nearest to a point of a body's skin, of the three whose triangle it lies in.
#include "render/layout.glsl"
#include "render/pick.glsl"

flat in uvec3 particles;
in vec3 squares;
in float along;
layout(location = 0) out uvec2 picked;

void main() {
  uint nearest = squares.y < squares.x ? particles.y : particles.x;
  if (squares.z < min(squares.x, squares.y)) nearest = particles.z;
  picked = uvec2(pick_word(PICK_PARTICLE, nearest), floatBitsToUint(along));
}
