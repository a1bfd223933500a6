#include "render/frame.glsl"
#include "render/sight.glsl"

layout(binding = UNIT_COLOR_MAP) uniform sampler2D color_map;
layout(location = LOCATION_BASE_COLOR) uniform vec4 base_color;
in vec2 on_disc;
in vec3 center;
flat in float shown;
flat in float pinned;
flat in float size;
layout(location = 0) out vec4 color;

void main() {
  float r2 = dot(on_disc, on_disc);
  float r = sqrt(r2);
  float edge = 1.5 * fwidth(r);
  float coverage = clamp((1.0 - r) / edge + 0.5, 0.0, 1.0);
  if (coverage <= 0.0) discard;
  vec3 forward = sight_of(center);
  vec3 right = normalize(cross(forward, vec3(0.0, 1.0, 0.0)));
  vec3 up = cross(right, forward);
  float depth = sqrt(max(1.0 - r2, 0.0));
  vec3 n_view = on_disc.x * right + on_disc.y * up - depth * forward;
  vec3 n = transpose(mat3(view)) * n_view;
  vec4 clip = projection * vec4(center + size * n_view, 1.0);
  gl_FragDepth = 0.5 + 0.5 * clip.z / clip.w;

  vec3 base = color_mode >= COLOR_STRAIN
                  ? textureLod(color_map, vec2(clamp(shown, 0.0, 1.0) * 255.0 / 256.0 + 0.5 / 256.0, 0.5), 0.0).rgb
                  : mix(base_color.rgb, vec3(0.75, 0.05, 0.04), pinned);
  vec3 v = -(transpose(mat3(view)) * forward);
  float wrapped = clamp((dot(n, sun.xyz) + 0.25) / 1.25, 0.0, 1.0);
  vec3 light = base * (0.42 * sun_light * wrapped + 0.6 * ambient(n));
  light += sun_light * 0.04 * highlight(n, v, sun.xyz, 0.35) + 0.25 * fresnel(dot(n, v), 0.04) * sky(reflect(-v, n));
  color = vec4(to_display(light), coverage);
}
