// Balls by ray and sphere, patched like footballs so that their spin is seen.
#include "render/frame.glsl"
#include "render/sight.glsl"
#include "render/shadow.glsl"

layout(binding = UNIT_COLOR_MAP) uniform sampler2D color_map;
in vec3 on_square;
flat in vec3 center;
flat in float size;
flat in vec4 turn;
flat in vec3 own_color;
flat in float shown;
layout(location = 0) out vec4 color;

// Below 0 in the twelve pentagons of a truncated icosahedron, above 0 in its twenty hexagons: which plane the direction
// meets first. Golden ratio φ; the planes' distances from the middle are 2.3274 and 2.2673 edges.
float patches(vec3 direction) {
  const float phi = 1.618034;
  vec3 a = abs(direction);
  float pentagon = max(max(a.y + phi * a.z, a.x + phi * a.y), a.z + phi * a.x) / (1.902113 * 2.327438);
  float hexagon = max(max(a.x + a.y + a.z, a.x / phi + phi * a.z), max(a.y / phi + phi * a.x, a.z / phi + phi * a.y)) /
                  (1.732051 * 2.267284);
  return hexagon - pentagon;
}

void main() {
  vec3 ray = sight_of(on_square);
  vec3 start = vec3((1.0 - viewer.w) * on_square.xy, 0.0);
  float along = dot(center - start, ray);
  vec3 beside = start + along * ray - center;
  float off = length(beside) / size;
  float coverage = clamp((1.0 - off) / fwidth(off) + 0.5, 0.0, 1.0);
  if (coverage <= 0.0) discard;
  vec3 n_view = normalize(beside / size - sqrt(max(1.0 - off * off, 0.0)) * ray);
  vec3 hit = center + size * n_view;
  vec4 clip = projection * vec4(hit, 1.0);
  gl_FragDepth = clamp(0.5 + 0.5 * clip.z / clip.w, 0.0, 1.0);

  mat3 to_world = transpose(mat3(view));
  vec3 n = to_world * n_view;
  vec3 v = -(to_world * ray);
  vec3 world = eye.xyz + to_world * hit;
  vec3 own = n + 2.0 * cross(-turn.xyz, cross(-turn.xyz, n) + turn.w * n);
  float at = patches(own);
  float blur = max(0.7 * fwidth(at), 1e-5);
  vec3 light_tone = color_mode == COLOR_SPEED
                        ? textureLod(color_map, vec2(clamp(shown, 0.0, 1.0) * 255.0 / 256.0 + 0.5 / 256.0, 0.5), 0.0).rgb
                        : own_color;
  vec3 base = mix(0.06 * light_tone + 0.012, light_tone, smoothstep(-blur, blur, at));

  float nl = max(dot(n, sun.xyz), 0.0);
  // From above the ball itself, whose own shade is in its ambient light: higher bodies keep the sky off.
  float open = skylight_above(world - 1.2 * size * transpose(mat3(lights[LIGHT_SKY]))[2], 2.0 * size);
  vec3 light = base * (0.46 * sun_light * nl * sphere_shade(world) + 0.62 * open * ambient(n));
  light += sun_light * 0.04 * highlight(n, v, sun.xyz, 0.3) + 0.3 * open * fresnel(dot(n, v), 0.04) * sky(reflect(-v, n));
  color = vec4(to_display(light), coverage);
}
