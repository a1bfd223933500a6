#include "render/layout.glsl"

layout(location = ATTRIBUTE_POSITION) in vec4 position;
flat out uint vertex_particle;

void main() {
  vertex_particle = uint(gl_VertexID);  // drawn by index, and indices are particles
  gl_Position = vec4(position.xyz, 1.0);
}
