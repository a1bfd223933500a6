// The finished picture into a window, whose framebuffer takes encoded values.
#include "render/layout.glsl"

layout(binding = UNIT_FRAME) uniform sampler2D picture;
in vec2 on_screen;
layout(location = 0) out vec4 colour;

void main() {
  vec3 light = textureLod(picture, 0.5 + 0.5 * on_screen, 0.0).rgb;
  vec3 low = 12.92 * light;
  vec3 high = 1.055 * pow(light, vec3(1.0 / 2.4)) - 0.055;
  colour = vec4(mix(high, low, lessThanEqual(light, vec3(0.0031308))), 1.0);
}
