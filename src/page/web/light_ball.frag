#include "lights.glsl"
uniform int light;
flat in float size;
in vec2 on_disc;
in float middle;
out vec4 cover;

void main() {
  float off = dot(on_disc, on_disc);
  if (off > 1.0) discard;
  cover = light_texel(light, middle);
  float reach = size * sqrt(1.0 - off);
  cover.zw += reach;
}
