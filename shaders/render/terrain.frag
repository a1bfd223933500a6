// Solid terrain: textured ground or another textured surface, in sun, sky and shadow. CUT_PLANE: ground with parts cut
// out, which the shape's distance tells.
#include "render/frame.glsl"
#include "render/landscape.glsl"
#include "render/sight.glsl"
#include "render/drawn_terrain.glsl"
#ifdef UNSHADOWED_PLANE
vec3 sunlight_at(vec3 position) { return vec3(sphere_shade(position)); }
float skylight_at(vec3 position) { return 1.0; }
#elif defined(SHADOWED_PLANE)
layout(binding = UNIT_SHADE) uniform sampler2D shade;
// From the point that is drawn, of the sun's light and of the sky's.
vec2 kept_off() { return textureLod(shade, gl_FragCoord.xy * viewport.zw, 0.0).xy; }
vec3 sunlight_at(vec3 position) { return mix(vec3(1.0), shadow_tint.rgb, kept_off().x) * sphere_shade(position); }
float skylight_at(vec3 position) { return 1.0 - kept_off().y; }
#else
#include "render/shadow.glsl"
#endif

layout(binding = UNIT_GROUND) uniform sampler2D ground;
#ifdef PLANE
layout(location = LOCATION_PLANE_POINT) uniform vec4 plane_point;
layout(location = LOCATION_PLANE_NORMAL) uniform vec4 plane_normal;
#endif
in vec3 world;
in vec3 local;
layout(location = 0) out vec4 color;

const float texture_size = 4.0;  // one repeat of the ground's texture [m]

void main() {
#ifdef SHADOWED_PLANE
  if (kept_off() == vec2(0.0)) discard;  // the plain ground is there
#endif
#ifdef CUT_PLANE
  if (distance_to(0u, world) > 1e-4 * plane_point.w) discard;
#endif
  vec3 v = to_eye(world);
#ifdef PLANE
  vec3 n = plane_normal.xyz;
  vec3 albedo = texture(ground, local.xy / texture_size).rgb;
  bool from_behind = dot(n, v) < 0.0;
#else
  vec3 n = normalize(local);
  vec3 weight = n * n;
  vec3 p = (world - terrains[0].geometry[0].xyz) / texture_size;
  vec3 albedo = weight.x * texture(ground, p.yz).rgb + weight.y * texture(ground, p.xz).rgb +
                weight.z * texture(ground, p.xy).rgb;
  albedo *= vec3(1.16, 1.20, 1.30);
  bool from_behind = false;
#endif
  float nl = max(dot(n, sun.xyz), 0.0);
  float open = from_behind ? 0.6 : skylight_at(world);
  // Close to a body light that ground and body pass on to each other is missing too.
  vec3 sunlit = nl > 0.0 && !from_behind ? sun_light * nl * sunlight_at(world) * (0.45 + 0.55 * open) : vec3(0.0);
  vec3 light = albedo * (0.46 * sunlit + 0.62 * open * ambient(n));
  light += 0.10 * open * fresnel(dot(n, v), 0.03) * horizon_light;
#ifdef PLANE
  vec3 off = (world - plane_point.xyz) / plane_point.w;
  float haze = smoothstep(0.0025, 0.50, dot(off, off));
  light = mix(light, landscape(-v), 1.0 - (1.0 - haze) * (1.0 - haze));
  color = vec4(to_display(light), from_behind ? 0.3 : 1.0);
#else
  color = vec4(to_display(light), 1.0);
#endif
}
