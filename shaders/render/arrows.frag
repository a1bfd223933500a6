// Plain colors with darker edges, so that arrows are told from each other and from any ground.
#include "render/layout.glsl"

layout(location = LOCATION_BASE_COLOR) uniform vec4 base_color;  // w: opacity
in float across;
in vec3 own_color;
layout(location = 0) out vec4 color;

void main() { color = vec4(own_color * mix(1.0, 0.45, smoothstep(0.4, 1.0, abs(across))), base_color.w); }
