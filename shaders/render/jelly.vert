#include "render/layout.glsl"
#include "render/cut.glsl"

layout(location = ATTRIBUTE_POSITION) in vec4 position;
layout(location = ATTRIBUTE_NORMAL) in vec4 normal;
layout(location = ATTRIBUTE_QUANTITY) in float quantity;
out vec3 world;
out vec3 surface_normal;
out float shown;

void main() {
  world = position.xyz;
  surface_normal = normal.xyz;
  shown = (quantity - quantity_range.x) * quantity_range.y;
  gl_Position = view_projection * vec4(world, 1.0);
  gl_ClipDistance[0] = kept(position.xyz);
}
