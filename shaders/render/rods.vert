#include "render/layout.glsl"

layout(location = ATTRIBUTE_POSITION) in vec4 position;
layout(location = ATTRIBUTE_NORMAL) in vec4 normal;
out vec3 world;
out vec3 surface_normal;

void main() {
  world = position.xyz;
  surface_normal = normal.xyz;
  gl_Position = view_projection * vec4(world, 1.0);
}
