// Plain colours with darker edges, so that arrows are told from each other and from any ground.
#include "render/layout.glsl"

layout(location = LOCATION_BASE_COLOUR) uniform vec4 base_colour;  // w: opacity
in float across;
in vec3 own_colour;
layout(location = 0) out vec4 colour;

void main() { colour = vec4(own_colour * mix(1.0, 0.45, smoothstep(0.4, 1.0, abs(across))), base_colour.w); }
