// The finished picture, in linear light, onto the canvas.
#include "encode.glsl"
uniform sampler2D picture;
in vec2 on_screen;
out vec4 colour;

void main() { colour = vec4(encoded(textureLod(picture, 0.5 + 0.5 * on_screen, 0.0).rgb), 1.0); }
