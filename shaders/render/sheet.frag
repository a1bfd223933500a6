// An opaque sheet, lit from both sides; some sunlight comes through. Where its inside is asked for it shows what lies behind.
#include "render/frame.glsl"
#include "render/sight.glsl"

layout(binding = UNIT_COLOR_MAP) uniform sampler2D color_map;
layout(location = LOCATION_BASE_COLOR) uniform vec4 base_color;
in vec3 world;
in vec3 surface_normal;
in float shown;
layout(location = 0) out vec4 color;

void main() {
  vec3 n = normalize(surface_normal);
  if (!gl_FrontFacing) n = -n;
  vec3 v = to_eye(world);
  bool mapped = color_mode >= COLOR_STRAIN;
  vec3 base = mapped ? textureLod(color_map, vec2(clamp(shown, 0.0, 1.0) * 255.0 / 256.0 + 0.5 / 256.0, 0.5), 0.0).rgb
                     : base_color.rgb;
  float nl = dot(n, sun.xyz);
  vec3 lit = vec3(clamp((nl + 0.15) / 1.15, 0.0, 1.0));
  lit += 0.35 * clamp(-nl, 0.0, 1.0) * base;
  vec3 light = base * (0.42 * sun_light * lit * sphere_shade(world) + 0.70 * ambient(n));
  // The sheen of fibers that stand out at the outline.
  float rim = 1.0 - max(dot(n, v), 0.0);
  light += 0.10 * rim * rim * rim * mix(base, vec3(1.0), 0.4) * ambient(n);
  color = vec4(to_display(light), 1.0 - 0.5 * see_through);
}
