#include "render/layout.glsl"
#include "render/daylight.glsl"

// Share of the sun that the terrain's balls let pass to a point outside them.
float sphere_shade(vec3 world) {
  float light = 1.0;
  for (uint i = 0u; i < shadow_sphere_count; ++i) {
    vec3 to_center = shadow_spheres[i].xyz - world;
    float along = dot(to_center, sun.xyz);
    float beside = length(to_center - along * sun.xyz);
    float blur = 0.06 * max(along, 0.0) + 0.01;
    if (along > 0.05 && length(to_center) > 1.001 * shadow_spheres[i].w)
      light *= smoothstep(-blur, blur, beside - shadow_spheres[i].w);
  }
  return light;
}
