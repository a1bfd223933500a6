#include "render/layout.glsl"
#include "render/light.glsl"

layout(location = LOCATION_LIGHT) uniform int light;
in float depth;
layout(location = 0) out vec4 covered;

void main() { covered = light_texel(light, depth, 0.0); }
