#include "lights.glsl"
uniform int light;
in float depth;
out vec4 cover;

void main() { cover = light_texel(light, depth); }
