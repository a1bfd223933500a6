// A translucent body: shaders/render/jelly.frag.
#include "frame.glsl"
#include "lights.glsl"
uniform sampler2D sun_map;
uniform sampler2D thickness_map;
uniform sampler2D behind;
uniform vec3 base_color;
uniform float reach;  // half the length that light travels inside [m]
in vec3 world;
in vec3 surface_normal;
in float shown;
out vec4 color;

void main() {
  vec3 n = normalize(surface_normal), v = to_eye(world);
  if (!gl_FrontFacing) n = -n;
  float nv = max(dot(n, v), 0.2);
  vec3 base = mapped == 1 ? on_scale(shown) : base_color;

  vec3 p = in_light(0, world);
  vec2 first = textureLod(sun_map, 0.5 + 0.5 * p.xy, 1.5).xy;
  float inside = first.x > 0.01 ? max(p.z - first.y / first.x - 0.04, 0.0) : 0.0;
  vec3 absorbed = -log(clamp(base, vec3(0.03), vec3(0.97))) / reach;
  vec3 arriving = exp(-(0.35 * absorbed + 0.28 / reach) * inside);
  float wrapped = clamp((dot(n, sun.xyz) + 0.35) / 1.35, 0.0, 1.0);
  vec3 sunlit = sun_light * arriving * (0.22 + 0.50 * wrapped);
  float through = max(dot(-v, sun.xyz), 0.0);
  sunlit += sun_light * exp(-0.9 * absorbed * inside) * 0.35 * through * through;

  vec2 at = gl_FragCoord.xy * viewport.zw;
  float crossed = max(textureLod(thickness_map, at, 0.0).r, 0.0);
  float thickness = sqrt(crossed * crossed + 4.0 * reach * reach);
  float opacity = mapped == 1 ? 0.94 : 1.0 - exp(-0.34 * thickness / reach);
  opacity *= 1.0 - 0.72 * see_through;
  vec3 bent = mat3(view) * n;
  vec2 shift = bent.xy * min(thickness, 2.0 * reach) * 0.11 / eye.w * vec2(viewport.y * viewport.z, 1.0);
  vec3 seen = textureLod(behind, at - shift * (1.0 - see_through), 0.0).rgb;
  vec3 tint = exp(-0.30 * absorbed * thickness * (1.0 - 0.85 * see_through));

  vec3 body = base * (sunlit + 0.72 * ambient(n) * (0.75 + 0.25 * n.y));
  float mirror = fresnel(nv, 0.035), rim = 1.0 - nv;
  rim = rim * rim * rim;
  vec3 light = body * opacity + rim * 0.55 * mix(base, vec3(1.0), 0.15) * ambient(n) * opacity;
  light = light * (1.0 - mirror) + studio(reflect(-v, n)) * mirror;
  light += sun_light * (0.035 * highlight(n, v, sun.xyz, 0.22) + 0.02 * highlight(n, v, sun.xyz, 0.5)) * step(inside, 0.25);
  color = vec4(to_display(light + seen * tint * (1.0 - opacity) * (1.0 - mirror)), 1.0);
}
