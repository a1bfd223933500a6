#include "render/layout.glsl"

layout(location = ATTRIBUTE_POSITION) in vec4 position;
layout(location = ATTRIBUTE_VELOCITY) in vec4 velocity;
layout(location = ATTRIBUTE_TURN) in vec4 turn;
layout(location = ATTRIBUTE_COLOR) in vec4 own_color;
out vec4 vertex_turn;
out vec3 vertex_color;
out float vertex_shown;

void main() {
  vertex_turn = turn;
  vertex_color = own_color.rgb;
  vertex_shown = (length(velocity.xyz) - quantity_range.x) * quantity_range.y;
  gl_Position = vec4(position.xyz, velocity.w == 0.0 ? 0.0 : position.w);
}
