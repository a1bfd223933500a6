// A plane of tiles in sun, sky and shadow. HOLED: without the parts that the shape cuts out.
#include "frame.glsl"
#include "landscape.glsl"
#include "shadow.glsl"
uniform sampler2D tiles;
uniform vec4 plane_point;
uniform vec3 plane_normal;
#ifdef HOLED
uniform sampler2D hole;    // 128 + 64ths of a texel that a place is off the surface
uniform vec3 hole_u, hole_v, hole_middle;
uniform float hole_half;   // half the side of the texture [m]
#endif
in vec3 world;
in vec2 local;
out vec4 color;

void main() {
#ifdef HOLED
  vec3 from = world - hole_middle;
  vec2 at = vec2(dot(from, hole_u), dot(from, hole_v)) / hole_half;
  float texels = float(textureSize(hole, 0).x);
  vec2 uv = (0.5 + 0.5 * at) * (texels - 1.0) / texels + 0.5 / texels;
  if (max(abs(at.x), abs(at.y)) < 1.0 && textureLod(hole, uv, 0.0).r * 255.0 - 128.0 > 16.0) discard;
#endif
  vec3 v = to_eye(world), n = plane_normal;
  vec3 albedo = texture(tiles, local / 4.0).rgb;
  bool behind = dot(n, v) < 0.0;
  float nl = max(dot(n, sun.xyz), 0.0), open = behind ? 0.6 : skylight_at(world);
  vec3 sunlit = nl > 0.0 && !behind ? sun_light * nl * sunlight_at(world) * (0.45 + 0.55 * open) : vec3(0.0);
  vec3 light = albedo * (0.46 * sunlit + 0.62 * open * ambient(n));
  light += 0.10 * open * fresnel(dot(n, v), 0.03) * horizon_light;
  vec3 off = (world - plane_point.xyz) / plane_point.w;
  float haze = smoothstep(0.0025, 0.50, dot(off, off));
  light = mix(light, landscape(-v), 1.0 - (1.0 - haze) * (1.0 - haze));
  color = vec4(to_display(light), behind ? 0.3 : 1.0);
}
