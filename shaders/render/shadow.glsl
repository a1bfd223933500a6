// Soft shadows on the terrain from the light maps.
#include "render/light.glsl"

layout(binding = UNIT_SUN_MAP) uniform sampler2D sun_map;
layout(binding = UNIT_SKY_MAP) uniform sampler2D sky_map;

float light_half_width(int light) { return light_boxes[light].center.w; }
float light_half_depth(int light) { return light_boxes[light].depth.x; }
float per_half_width(int light) { return light_boxes[light].depth.y; }

#include "render/soft_shadow.glsl"

// Light of the sun that reaches a point of the terrain, by color.
vec3 sunlight_at(vec3 world) { return mix(vec3(1.0), shadow_tint.rgb, sun_kept_off(world)) * sphere_shade(world); }

// Light of the sky that reaches a point of the terrain, 0…1.
float skylight_at(vec3 world) { return 1.0 - sky_kept_off(world); }

// The same of a point above a ball: higher bodies keep it off. Those nearer than `soft` [m] count for less: what they
// cover itself is no edge of a shadow.
float skylight_above(vec3 world, float soft) {
  vec3 p = in_light(LIGHT_SKY, world);
  vec2 there = around(sky_map, p.xy).xw;
  if (there.x == 0.0) return 1.0;
  float above = p.z - (light_boxes[LIGHT_SKY].depth.x - there.y / there.x);
  if (above <= 0.0) return 1.0;
  float share = covered(LIGHT_SKY, sky_map, p.xy, 0.9 * above) * min(above / soft, 1.0);
  return 1.0 - 0.75 * sky_share(share, above, 0.5 * light_boxes[LIGHT_SKY].center.w);
}
