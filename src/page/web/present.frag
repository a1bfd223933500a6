// The finished image, in linear light, onto the canvas.
#include "encode.glsl"
uniform sampler2D image;
in vec2 on_screen;
out vec4 color;

void main() { color = vec4(encoded(textureLod(image, 0.5 + 0.5 * on_screen, 0.0).rgb), 1.0); }
