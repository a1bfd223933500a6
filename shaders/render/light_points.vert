// Particles into a light map.
#include "render/layout.glsl"

layout(location = ATTRIBUTE_POSITION) in vec4 position;

void main() { gl_Position = vec4(position.xyz, 1.0); }
