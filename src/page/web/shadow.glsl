// Soft shadows from the light maps: their mipmaps, the coarser the farther away a body is.
#include "lights.glsl"
uniform sampler2D sun_map;
uniform sampler2D sky_map;
uniform vec3 shadow_tint;

float smooth_level(sampler2D map, vec2 uv, float level) {
  vec2 size = vec2(textureSize(map, 0)) * exp2(-level);
  vec2 p = uv * size - 0.5, f = fract(p), base = p - f, f2 = f * f, f3 = f2 * f;
  vec2 w0 = (1.0 - 3.0 * f + 3.0 * f2 - f3) / 6.0;
  vec2 w1 = (4.0 - 6.0 * f2 + 3.0 * f3) / 6.0;
  vec2 w3 = f3 / 6.0, w2 = 1.0 - w0 - w1 - w3, low = w0 + w1, high = w2 + w3;
  vec2 a = (base - 0.5 + w1 / low) / size, b = (base + 1.5 + w3 / high) / size;
  return low.y * (low.x * textureLod(map, a, level).x + high.x * textureLod(map, vec2(b.x, a.y), level).x) +
         high.y * (low.x * textureLod(map, vec2(a.x, b.y), level).x + high.x * textureLod(map, b, level).x);
}

float covered(int light, sampler2D map, vec2 place, float reach) {
  float texels = reach / lights[light].centre.w * 0.5 * float(textureSize(map, 0).x);
  float level = clamp(log2(max(texels, 1.0)), 0.0, 6.0), sharp = floor(level);
  vec2 uv = 0.5 + 0.5 * place;
  float share = mix(smooth_level(map, uv, sharp), smooth_level(map, uv, sharp + 1.0), level - sharp);
  vec2 border = smoothstep(vec2(1.0), vec2(0.85), abs(place));
  return clamp(share, 0.0, 1.0) * border.x * border.y;
}

vec4 around(sampler2D map, vec2 place) {
  if (abs(place.x) >= 1.0 || abs(place.y) >= 1.0) return vec4(0.0);
  vec2 uv = 0.5 + 0.5 * place;
  return textureLod(map, uv, 5.0) + 0.05 * textureLod(map, uv, 7.0) + 0.001 * textureLod(map, vec2(0.5), 9.0);
}

vec3 sunlight_at(vec3 world) {
  vec3 p = in_light(0, world);
  vec2 there = around(sun_map, p.xy).xy;
  float off = 0.0;
  if (there.x > 0.0) {
    float above = p.z - there.y / there.x;
    if (above > 0.0) off = covered(0, sun_map, p.xy, 0.10 * above);
  }
  return mix(vec3(1.0), shadow_tint, off) * sphere_shade(world);
}

float skylight_at(vec3 world) {
  vec3 p = in_light(1, world);
  vec4 there = around(sky_map, p.xy);
  if (there.x == 0.0) return 1.0;
  float lowest = there.z / there.x - lights[1].depth, highest = lights[1].depth - there.w / there.x;
  if (p.z <= highest) return 1.0;
  float gap = max(p.z - lowest, 0.0), height = max(lowest - highest, 0.0);
  float share = covered(1, sky_map, p.xy, 0.9 * gap + 0.15 * height);
  float size = 0.5 * height + 0.1 * lights[1].centre.w, near = size / (size + gap);
  return 1.0 - 0.9 * share * near * near;
}
