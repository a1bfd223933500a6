// Balls into a light map: like particles, each with its own radius.
#include "render/layout.glsl"

layout(location = ATTRIBUTE_POSITION) in vec4 position;
layout(location = ATTRIBUTE_VELOCITY) in vec4 velocity;

void main() { gl_Position = vec4(position.xyz, velocity.w == 0.0 ? 0.0 : position.w); }
