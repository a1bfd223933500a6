// Corners of tetrahedra that a cut crosses.
#include "render/layout.glsl"

layout(location = ATTRIBUTE_POSITION) in vec4 position;
layout(location = ATTRIBUTE_QUANTITY) in float quantity;
layout(location = ATTRIBUTE_NORMAL) in vec3 listed_place;  // where lattices have empty cells
layout(location = LOCATION_FIRST) uniform uint first_particle;
layout(location = LOCATION_LATTICE) uniform uvec4 size;  // 0: places are listed
// Place in the lattice, spacings from its first particle, and what is shown: together, since Mesa 25's llvmpipe mixes up
// a vec3 and a float that a geometry shader reads by index.
out vec4 vertex_place_and_shown;
flat out uint vertex_particle;

void main() {
  vertex_particle = uint(gl_VertexID);  // drawn by index, and indices are particles
  uint local = vertex_particle - first_particle;
  vec3 place = listed_place;
  if (size.x > 0u) place = vec3(local / (size.y * size.z), local / size.z % size.y, local % size.z);
  vertex_place_and_shown = vec4(place, (quantity - quantity_range.x) * quantity_range.y);
  gl_Position = vec4(position.xyz, 1.0);
}
