// What bodies cover, pale and translucent, into a window whose framebuffer takes encoded values.
#include "render/encode.glsl"
#include "render/layout.glsl"

layout(binding = UNIT_FRAME) uniform sampler2D image;  // alpha: how much bodies cover
layout(location = LOCATION_BASE_COLOR) uniform vec4 background;  // around them
in vec2 on_screen;
layout(location = 0) out vec4 color;

const vec3 pale = vec3(0.72, 0.84, 1.0);

void main() {
  vec4 seen = textureLod(image, 0.5 + 0.5 * on_screen, 0.0);
  if (seen.a <= 0.0) discard;
  vec3 body = clamp((seen.rgb - (1.0 - seen.a) * background.rgb) / seen.a, 0.0, 1.0);
  color = vec4(mix(encoded(body), pale, 0.45), 0.5 * seen.a);
}
