// Soft shadows on the terrain from the light maps.
#include "render/light.glsl"

layout(binding = UNIT_SUN_MAP) uniform sampler2D sun_map;
layout(binding = UNIT_SKY_MAP) uniform sampler2D sky_map;

// One level of a map through a cubic B-spline: four bilinear reads at the places that give sixteen texels their weights.
vec2 smooth_level(sampler2D map, vec2 uv, float level) {
  // Not textureSize() of the level: where neighbours' levels differ, llvmpipe answers all of them for one.
  vec2 size = vec2(textureSize(map, 0)) * exp2(-level);
  vec2 p = uv * size - 0.5;
  vec2 f = fract(p);
  vec2 base = p - f;
  vec2 f2 = f * f;
  vec2 f3 = f2 * f;
  vec2 w0 = (1.0 - 3.0 * f + 3.0 * f2 - f3) / 6.0;
  vec2 w1 = (4.0 - 6.0 * f2 + 3.0 * f3) / 6.0;
  vec2 w3 = f3 / 6.0;
  vec2 w2 = 1.0 - w0 - w1 - w3;
  vec2 low = w0 + w1;
  vec2 high = w2 + w3;
  vec2 at_low = (base - 0.5 + w1 / low) / size;
  vec2 at_high = (base + 1.5 + w3 / high) / size;
  return low.y * (low.x * textureLod(map, at_low, level).xy +
                  high.x * textureLod(map, vec2(at_high.x, at_low.y), level).xy) +
         high.y * (low.x * textureLod(map, vec2(at_low.x, at_high.y), level).xy +
                   high.x * textureLod(map, at_high, level).xy);
}

vec2 smooth_map(sampler2D map, vec2 uv, float level) {
  float floor_level = floor(level);
  return mix(smooth_level(map, uv, floor_level), smooth_level(map, uv, floor_level + 1.0), level - floor_level);
}

// How much of a light of angular size `spread` (tangent) the bodies keep from a point, 0…1; y: how far above they are [m].
// Bodies nearer than `soft` [m] count for less: what they cover itself is no edge of a shadow.
vec2 covered(int light, sampler2D map, vec3 world, float spread, float soft) {
  vec3 p = in_light(light, world);
  if (abs(p.x) >= 1.0 || abs(p.y) >= 1.0) return vec2(0.0);
  vec2 uv = 0.5 + 0.5 * p.xy;
  // The depth of what is near counts most, and that of what is far alone where nothing is near: no edge in between.
  vec2 around = textureLod(map, uv, 5.0).xy + 0.05 * textureLod(map, uv, 7.0).xy +
                0.001 * textureLod(map, vec2(0.5), 9.0).xy;
  if (around.x == 0.0) return vec2(0.0);
  float above = p.z - around.y / around.x;
  if (above <= 0.0) return vec2(0.0);
  float texels = above * spread * light_boxes[light].depth.y * 0.5 * float(textureSize(map, 0).x);
  float level = clamp(log2(max(texels, 1.0)), 0.0, 6.0);
  // The map ends here: let the shadow end gently before it.
  vec2 border = smoothstep(vec2(1.0), vec2(0.85), abs(p.xy));
  float near = min(above / soft, 1.0);
  return vec2(clamp(smooth_map(map, uv, level).x, 0.0, 1.0) * border.x * border.y * near, above);
}

// Shares of the sun's and of the sky's light that bodies keep from a point of the terrain: of the sky's, more close under
// a body.
float sun_kept_off(vec3 world) { return covered(LIGHT_SUN, sun_map, world, 0.10, 1e-6).x; }
float sky_kept_off(vec3 world, float soft) {
  vec2 c = covered(LIGHT_SKY, sky_map, world, 0.9, soft);
  float size = light_boxes[LIGHT_SKY].centre.w;
  float near = size * 0.5 / (size * 0.5 + c.y);
  return 0.75 * c.x * near * near;
}

// Light of the sun that reaches a point of the terrain, by colour.
vec3 sunlight_at(vec3 world) { return mix(vec3(1.0), shadow_tint.rgb, sun_kept_off(world)) * sphere_shade(world); }

// Light of the sky that reaches a point of the terrain, 0…1.
float skylight_at(vec3 world, float soft) { return 1.0 - sky_kept_off(world, soft); }
float skylight_at(vec3 world) { return skylight_at(world, 1e-6); }
