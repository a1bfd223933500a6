// Particles into a light map.
#include "render/layout.glsl"
#include "render/cut.glsl"

layout(location = ATTRIBUTE_POSITION) in vec4 position;

void main() { gl_Position = vec4(position.xyz, kept(position.xyz) < 0.0 ? 0.0 : 1.0); }
