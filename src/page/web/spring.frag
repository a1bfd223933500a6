#include "frame.glsl"
uniform vec3 base_color;
uniform int fades;
in float across;
in vec3 sideways;
in vec3 towards_eye;
in float shown;
in vec2 reach;
out vec4 color;

void main() {
  vec3 base = mapped == 1 ? on_scale(shown) : base_color;
  float round = fades == 0 ? across : across * clamp(reach.y - 0.5, 0.0, 1.0);
  vec3 n_view = round * sideways + sqrt(max(1.0 - round * round, 0.0)) * towards_eye;
  vec3 n = transpose(mat3(view)) * normalize(n_view);
  float wrapped = clamp((dot(n, sun.xyz) + 0.5) / 1.5, 0.0, 1.0);
  float within = clamp(reach.x - abs(across) * reach.x, 0.0, 1.0);
  float coverage = fades == 0 ? 1.0 : within * min(2.0 * reach.y, 1.0);
  color = vec4(to_display(base * (0.45 * sun_light * wrapped + 0.65 * ambient(n))), coverage);
}
