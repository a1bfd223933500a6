// The finished image into a window, whose framebuffer takes encoded values.
#include "render/encode.glsl"
#include "render/layout.glsl"

layout(binding = UNIT_FRAME) uniform sampler2D image;
in vec2 on_screen;
layout(location = 0) out vec4 color;

void main() {
  vec3 light = textureLod(image, 0.5 + 0.5 * on_screen, 0.0).rgb;
  color = vec4(encoded(light), 1.0);
}
