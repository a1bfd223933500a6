// The particle that is nearest to a point of a section, of the four whose tetrahedron it lies in.
#include "render/layout.glsl"
#include "render/pick.glsl"

flat in uvec4 particles;
in vec4 squares;
in float along;
layout(location = 0) out uvec2 picked;

void main() {
  int nearest = 0;
  for (int i = 1; i < 4; ++i)
    if (squares[i] < squares[nearest]) nearest = i;
  picked = uvec2(pick_word(PICK_PARTICLE, particles[nearest]), floatBitsToUint(along));
}
