// Balls by ray and sphere, patched like footballs so that their spin is seen (shaders/render/balls.frag); particles are plain.
#include "frame.glsl"
#include "shadow.glsl"
flat in vec3 center;
flat in float size;
flat in vec4 turn;
flat in vec3 own_color;
in vec3 on_square;
out vec4 color;

float patches(vec3 direction) {
  const float phi = 1.618034;
  vec3 a = abs(direction);
  float pentagon = max(max(a.y + phi * a.z, a.x + phi * a.y), a.z + phi * a.x) / (1.902113 * 2.327438);
  float hexagon = max(max(a.x + a.y + a.z, a.x / phi + phi * a.z), max(a.y / phi + phi * a.x, a.z / phi + phi * a.y)) /
                  (1.732051 * 2.267284);
  return hexagon - pentagon;
}

void main() {
  vec3 ray = normalize(vec3(viewer.w * on_square.xy, on_square.z));
  if (viewer.w == 0.0) ray = vec3(0.0, 0.0, -1.0);
  vec3 start = vec3((1.0 - viewer.w) * on_square.xy, 0.0);
  vec3 beside = start + dot(center - start, ray) * ray - center;
  float off = length(beside) / size;
  float coverage = clamp((1.0 - off) / fwidth(off) + 0.5, 0.0, 1.0);
  if (coverage <= 0.0) discard;
  vec3 n_view = normalize(beside / size - sqrt(max(1.0 - off * off, 0.0)) * ray);
  vec3 hit = center + size * n_view;
  vec4 clip = projection * vec4(hit, 1.0);
  gl_FragDepth = clamp(0.5 + 0.5 * clip.z / clip.w, 0.0, 1.0);

  mat3 to_world = transpose(mat3(view));
  vec3 n = to_world * n_view, v = -(to_world * ray), world = eye.xyz + to_world * hit;
  vec3 base = own_color;
  if (turn != vec4(0.0)) {
    vec4 t = normalize(turn);
    vec3 own = n + 2.0 * cross(-t.xyz, cross(-t.xyz, n) + t.w * n);
    float at = patches(own), blur = max(0.7 * fwidth(at), 1e-5);
    base = mix(0.06 * base + 0.012, base, smoothstep(-blur, blur, at));
  }
  float nl = max(dot(n, sun.xyz), 0.0);
  vec3 light = base * (0.46 * sun_light * nl * sphere_shade(world) + 0.62 * ambient(n));
  light += sun_light * 0.04 * highlight(n, v, sun.xyz, 0.3) + 0.3 * fresnel(dot(n, v), 0.04) * sky(reflect(-v, n));
  color = vec4(to_display(light), coverage);
}
