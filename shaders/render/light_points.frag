// Balls and particles into a light map, and springs, which are flat.
#include "render/layout.glsl"
#include "render/light.glsl"

layout(location = LOCATION_LIGHT) uniform int light;
in float depth;
in vec2 on_disc;
flat in float size;  // radius [m]
layout(location = 0) out vec4 covered;

void main() {
  float off = dot(on_disc, on_disc);
  if (off > 1.0) discard;
  covered = light_texel(light, depth, size * sqrt(1.0 - off));
}
