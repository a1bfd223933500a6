#include "render/layout.glsl"

layout(location = ATTRIBUTE_POSITION) in vec4 from;
layout(location = ATTRIBUTE_VELOCITY) in vec4 along;  // [m]; w: 1 with a head, 0 without
layout(location = ATTRIBUTE_COLOR) in vec4 own_color;
out vec4 vertex_along;
out vec3 vertex_color;

void main() {
  vertex_along = along;
  vertex_color = own_color.rgb;
  gl_Position = vec4(from.xyz, 1.0);
}
