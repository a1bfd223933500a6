// An image at half its size: the mean light of two by two pixels and all their samples, whichever part of it is asked for.
#include "render/layout.glsl"

#ifdef SEVERAL_SAMPLES
layout(binding = UNIT_FRAME) uniform sampler2DMS image;
layout(location = LOCATION_COUNT) uniform int samples;
#else
layout(binding = UNIT_FRAME) uniform sampler2D image;
const int samples = 1;
#endif
layout(location = 0) out vec4 color;

void main() {
#ifdef SEVERAL_SAMPLES
  ivec2 last = textureSize(image) - 1;
#else
  ivec2 last = textureSize(image, 0) - 1;
#endif
  ivec2 corner = 2 * ivec2(gl_FragCoord.xy);
  vec3 sum = vec3(0.0);
  for (int i = 0; i < 4; ++i)
    for (int s = 0; s < samples; ++s) sum += texelFetch(image, min(corner + ivec2(i & 1, i >> 1), last), s).rgb;
  color = vec4(sum / float(4 * samples), 1.0);
}
