// What all programs of the page share.
uniform mat4 view, projection, view_projection, clip_to_world;
uniform vec4 eye;          // w: the target's distance [m]
uniform vec4 viewer;       // the eye and 1, or where sight lines come from and 0 if they are parallel
uniform vec4 sun;          // towards it
uniform vec4 viewport;     // width, height, 1/width, 1/height
uniform vec4 shades[4];    // balls of the terrain: center, radius [m]; radius 0: none
uniform vec2 range;        // least value of the scale, 1/(largest − least)
uniform int mapped;        // 1: colors are those of the scale
uniform float see_through; // 1: bodies show what is inside
uniform sampler2D scale;
#include "daylight.glsl"

vec3 to_eye(vec3 position) { return normalize(viewer.xyz - viewer.w * position); }

vec3 on_scale(float value) {
  return textureLod(scale, vec2(clamp((value - range.x) * range.y, 0.0, 1.0) * 255.0 / 256.0 + 0.5 / 256.0, 0.5), 0.0).rgb;
}

float sphere_shade(vec3 world) {
  float light = 1.0;
  for (int i = 0; i < 4; ++i) {
    vec3 to_center = shades[i].xyz - world;
    float along = dot(to_center, sun.xyz);
    float beside = length(to_center - along * sun.xyz);
    float blur = 0.06 * max(along, 0.0) + 0.01;
    if (shades[i].w > 0.0 && along > 0.05 && length(to_center) > 1.001 * shades[i].w)
      light *= smoothstep(-blur, blur, beside - shades[i].w);
  }
  return light;
}
