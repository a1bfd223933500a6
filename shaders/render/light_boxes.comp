// The map of each light, from the box of the bodies: one invocation per light.
#include "render/layout.glsl"
#include "render/bounds.glsl"
#include "compute/dispatch.glsl"

layout(std430, binding = BINDING_LIGHT_BOXES_OUT) restrict writeonly buffer LightBoxes { LightBox light_boxes[LIGHTS]; };

vec3 decoded(uvec3 bits) { return vec3(unordered(bits.x), unordered(bits.y), unordered(bits.z)); }

void main() {
  uint light = item_index();
  if (light >= uint(LIGHTS)) return;
  vec3 lower = decoded(bounds[light].lower.xyz);
  vec3 upper = decoded(bounds[light].upper.xyz);
  if (bounds[light].lower.x > bounds[light].upper.x) lower = upper = vec3(0.0);  // nothing there
  vec3 size = upper - lower;
  float margin = light == uint(LIGHT_SKY) ? SKY_MAP_MARGIN : SUN_MAP_MARGIN;
  float extent = margin * max(size.x, size.y) + MAP_BORDER;
  light_boxes[light].center = vec4(0.5 * (lower + upper), extent);
  light_boxes[light].depth = vec4(0.55 * size.z + 0.05, 1.0 / extent, 0.0, 0.0);
}
