// What one light's maps keep from a plane, for an image of half the image's size: it is soft, and dear. The whole plane
// is drawn, also where bodies hide it or a shape cuts it, so nothing in the image has an edge that the image has not:
// it can be magnified linearly. SHADED_LIGHT: which light.
#include "render/frame.glsl"
#include "render/shadow.glsl"

in vec3 world;
in vec3 local;
layout(location = 0) out vec2 kept_off;  // of the sun's light, of the sky's; the lights are added

void main() {
#if SHADED_LIGHT == LIGHT_SUN
  kept_off = vec2(sun_kept_off(world), 0.0);
#else
  kept_off = vec2(0.0, sky_kept_off(world));
#endif
}
