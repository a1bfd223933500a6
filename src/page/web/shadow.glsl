// Soft shadows from the light maps, as in our images.
#include "lights.glsl"
uniform sampler2D sun_map;
uniform sampler2D sky_map;
uniform vec3 shadow_tint;

float light_half_width(int light) { return lights[light].center.w; }
float light_half_depth(int light) { return lights[light].depth; }
float per_half_width(int light) { return 1.0 / lights[light].center.w; }

#include "soft_shadow.glsl"

vec3 sunlight_at(vec3 world) { return mix(vec3(1.0), shadow_tint, sun_kept_off(world)) * sphere_shade(world); }

float skylight_at(vec3 world) { return 1.0 - sky_kept_off(world); }
