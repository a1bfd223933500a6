#include "render/frame.glsl"

layout(binding = UNIT_COLOR_MAP) uniform sampler2D color_map;
layout(location = LOCATION_FADES) uniform int fades;
layout(location = LOCATION_BASE_COLOR) uniform vec4 base_color;
in float across;
in vec3 sideways;
in vec3 towards_eye;
in float shown;
in vec2 reach;
layout(location = 0) out vec4 color;

void main() {
  vec3 base = color_mode >= COLOR_STRAIN
                  ? textureLod(color_map, vec2(clamp(shown, 0.0, 1.0) * 255.0 / 256.0 + 0.5 / 256.0, 0.5), 0.0).rgb
                  : base_color.rgb;
  // What a pixel spans has one tone.
  float round = fades == 0 ? across : across * clamp(reach.y - 0.5, 0.0, 1.0);
  vec3 n_view = round * sideways + sqrt(max(1.0 - round * round, 0.0)) * towards_eye;
  vec3 n = transpose(mat3(view)) * normalize(n_view);
  float wrapped = clamp((dot(n, sun.xyz) + 0.5) / 1.5, 0.0, 1.0);
  float within = clamp(reach.x - abs(across) * reach.x, 0.0, 1.0);
  float coverage = fades == 0 ? 1.0 : within * min(2.0 * reach.y, 1.0);
  color = vec4(to_display(base * (0.45 * sun_light * wrapped + 0.65 * ambient(n))), coverage);
}
