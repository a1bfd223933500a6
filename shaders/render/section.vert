// Corners of tetrahedra that a cut crosses.
#include "render/layout.glsl"

layout(location = ATTRIBUTE_POSITION) in vec4 position;
layout(location = ATTRIBUTE_QUANTITY) in float quantity;
layout(location = LOCATION_FIRST) uniform uint first_particle;
layout(location = LOCATION_EDGE) uniform uint edge;
out vec3 vertex_place;  // in the lattice, spacings from its first particle
out float vertex_shown;
flat out uint vertex_particle;

void main() {
  vertex_particle = uint(gl_VertexID);  // drawn by index, and indices are particles
  uint local = vertex_particle - first_particle;
  vertex_place = vec3(local / (edge * edge), local / edge % edge, local % edge);
  vertex_shown = (quantity - quantity_range.x) * quantity_range.y;
  gl_Position = vec4(position.xyz, 1.0);
}
