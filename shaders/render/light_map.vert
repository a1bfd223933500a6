// Surfaces of bodies into a light map.
#include "render/layout.glsl"
#include "render/light.glsl"
#include "render/cut.glsl"

layout(location = ATTRIBUTE_POSITION) in vec4 position;
layout(location = LOCATION_LIGHT) uniform int light;
out float depth;

void main() {
  vec3 p = in_light(light, position.xyz);
  depth = p.z;
  gl_Position = vec4(p.xy, p.z / light_boxes[light].depth.x, 1.0);
  gl_ClipDistance[0] = kept(position.xyz);
}
