#include "render/layout.glsl"

layout(location = ATTRIBUTE_POSITION) in vec4 position;
layout(location = ATTRIBUTE_QUANTITY) in float quantity;
out float vertex_shown;
out float vertex_pinned;

void main() {
  vertex_shown = (quantity - quantity_range.x) * quantity_range.y;
  vertex_pinned = position.w == 0.0 ? 1.0 : 0.0;
  gl_Position = vec4(position.xyz, 1.0);
}
