// The inside of a body where it is cut: its own color in the light that falls there, or the scale's as the legend shows it;
// thin lines are the faces of the cells.
#include "render/frame.glsl"

layout(binding = UNIT_COLOR_MAP) uniform sampler2D color_map;
layout(location = LOCATION_BASE_COLOR) uniform vec4 base_color;
in vec3 world;
in vec3 place;
in float shown;
layout(location = 0) out vec4 color;

// Lines where a coordinate is an integer, a pixel wide; none where they crowd, or where the plane runs along a face.
float lines(float coordinate) {
  float pixel = max(fwidth(coordinate), 1e-5);
  float off = abs(fract(coordinate + 0.5) - 0.5);
  return (1.0 - smoothstep(0.5, 1.5, off / pixel)) * clamp(1.25 - 5.0 * pixel, 0.0, 1.0) * step(2e-4, pixel);
}

void main() {
  vec3 light;
  if (section.z > 0.0) {
    // Springs are drawn before it: a quiet ground for their colors.
    light = color_mode >= COLOR_STRAIN ? vec3(0.30) : 0.55 * mix(base_color.rgb, vec3(0.2), 0.35);
  } else if (color_mode >= COLOR_STRAIN) {
    light = textureLod(color_map, vec2(clamp(shown, 0.0, 1.0) * 255.0 / 256.0 + 0.5 / 256.0, 0.5), 0.0).rgb;
  } else {
    vec3 n = gl_FrontFacing ? cut.xyz : -cut.xyz;
    float wrapped = clamp((dot(n, sun.xyz) + 0.5) / 1.5, 0.0, 1.0);
    light = to_display(base_color.rgb * (0.40 * sun_light * wrapped + 0.62 * ambient(n)));
  }
  float line = max(max(lines(place.x), lines(place.y)), lines(place.z));
  color = vec4(mix(light, 0.35 * light, 0.7 * line * (1.0 - section.z)), 1.0);
}
