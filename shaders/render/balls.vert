#include "render/layout.glsl"

layout(location = ATTRIBUTE_POSITION) in vec4 position;
layout(location = ATTRIBUTE_VELOCITY) in vec4 velocity;
layout(location = ATTRIBUTE_TURN) in vec4 turn;
layout(location = ATTRIBUTE_COLOUR) in vec4 own_colour;
out vec4 vertex_turn;
out vec3 vertex_colour;
out float vertex_shown;

void main() {
  vertex_turn = turn;
  vertex_colour = own_colour.rgb;
  vertex_shown = (length(velocity.xyz) - quantity_range.x) * quantity_range.y;
  gl_Position = vec4(position.xyz, velocity.w == 0.0 ? 0.0 : position.w);
}
