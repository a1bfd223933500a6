// Soft shadows from the light maps (render/light.glsl): also of pages for browsers (src/page/web), which speak GLSL ES 3.00.
// The includer declares the maps `sun_map` and `sky_map`, LIGHT_SUN, LIGHT_SKY, in_light(), and of a light's box half its width
// and depth [m], `light_half_width()`, `light_half_depth()`, and the inverse of the former, `per_half_width()`.

// The covered share in one level of a map through a cubic B-spline: four bilinear reads at the places that give sixteen
// texels their weights.
float smooth_level(sampler2D map, vec2 uv, float level) {
  // Not textureSize() of the level: where neighbors' levels differ, llvmpipe answers all of them for one.
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
  return low.y * (low.x * textureLod(map, at_low, level).x +
                  high.x * textureLod(map, vec2(at_high.x, at_low.y), level).x) +
         high.y * (low.x * textureLod(map, vec2(at_low.x, at_high.y), level).x +
                   high.x * textureLod(map, at_high, level).x);
}

// The covered share around a place −1…1 of a light's map, blurred over `reach` [m].
float covered(int light, sampler2D map, vec2 place, float reach) {
  float texels = reach * per_half_width(light) * 0.5 * float(textureSize(map, 0).x);
  float level = clamp(log2(max(texels, 1.0)), 0.0, 6.0);
  float sharp = floor(level);
  vec2 uv = 0.5 + 0.5 * place;
  float share = mix(smooth_level(map, uv, sharp), smooth_level(map, uv, sharp + 1.0), level - sharp);
  // The map ends here: let the shadow end gently before it.
  vec2 border = smoothstep(vec2(1.0), vec2(0.85), abs(place));
  return clamp(share, 0.0, 1.0) * border.x * border.y;
}

// What a map says of the bodies around a place −1…1 of it; x is 0 where there are none. The depth of what is near counts
// most, and that of what is far alone where nothing is near: no edge in between.
vec4 around(sampler2D map, vec2 place) {
  if (abs(place.x) >= 1.0 || abs(place.y) >= 1.0) return vec4(0.0);
  vec2 uv = 0.5 + 0.5 * place;
  return textureLod(map, uv, 5.0) + 0.05 * textureLod(map, uv, 7.0) + 0.001 * textureLod(map, vec2(0.5), 9.0);
}

// Share of the sun's light that bodies keep from a point.
float sun_kept_off(vec3 world) {
  vec3 p = in_light(LIGHT_SUN, world);
  vec2 there = around(sun_map, p.xy).xy;
  if (there.x == 0.0) return 0.0;
  float above = p.z - there.y / there.x;  // that they are [m]
  return above <= 0.0 ? 0.0 : covered(LIGHT_SUN, sun_map, p.xy, 0.10 * above);
}

// Share of the sky's light that bodies at `gap` [m] keep off: of those that are `size` [m] large, much where they are close.
float sky_share(float share, float gap, float size) {
  float near = size / (size + gap);
  return share * near * near;
}

// The same of a point of the terrain: darkest where a body touches it, less around that the higher the body.
float sky_kept_off(vec3 world) {
  vec3 p = in_light(LIGHT_SKY, world);
  vec4 there = around(sky_map, p.xy);
  if (there.x == 0.0) return 0.0;
  float half_depth = light_half_depth(LIGHT_SKY);
  float lowest = there.z / there.x - half_depth, highest = half_depth - there.w / there.x;
  if (p.z <= highest) return 0.0;
  float gap = max(p.z - lowest, 0.0), height = max(lowest - highest, 0.0);
  float share = covered(LIGHT_SKY, sky_map, p.xy, 0.9 * gap + 0.15 * height);
  return 0.9 * sky_share(share, gap, 0.5 * height + 0.1 * light_half_width(LIGHT_SKY));
}
