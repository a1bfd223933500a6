#include "render/frame.glsl"

layout(binding = UNIT_COLOUR_MAP) uniform sampler2D colour_map;
layout(location = LOCATION_BASE_COLOUR) uniform vec4 base_colour;
in float across;
in vec3 sideways;
in vec3 towards_eye;
in float shown;
layout(location = 0) out vec4 colour;

void main() {
  vec3 base = colour_mode >= COLOUR_STRAIN
                  ? textureLod(colour_map, vec2(clamp(shown, 0.0, 1.0) * 255.0 / 256.0 + 0.5 / 256.0, 0.5), 0.0).rgb
                  : base_colour.rgb;
  vec3 n_view = across * sideways + sqrt(max(1.0 - across * across, 0.0)) * towards_eye;
  vec3 n = transpose(mat3(view)) * normalize(n_view);
  float wrapped = clamp((dot(n, sun.xyz) + 0.5) / 1.5, 0.0, 1.0);
  colour = vec4(to_display(base * (0.45 * sun_light * wrapped + 0.65 * ambient(n))), 1.0);
}
