#include "render/layout.glsl"

layout(location = ATTRIBUTE_POSITION) in vec4 from;
layout(location = ATTRIBUTE_VELOCITY) in vec4 along;  // [m]; w: 1 with a head, 0 without
layout(location = ATTRIBUTE_COLOUR) in vec4 own_colour;
out vec4 vertex_along;
out vec3 vertex_colour;

void main() {
  vertex_along = along;
  vertex_colour = own_colour.rgb;
  gl_Position = vec4(from.xyz, 1.0);
}
