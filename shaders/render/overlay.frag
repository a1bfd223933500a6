#include "render/layout.glsl"

layout(binding = UNIT_GLYPHS) uniform sampler2D glyphs;
layout(binding = UNIT_COLOR_MAP) uniform sampler2D color_map;
in vec2 uv;
in vec4 fill;
flat in vec4 kind;
layout(location = 0) out vec4 color;

void main() {
  color = fill;
  if (kind.x == 0.0) {
    // A glyph: coverage, read texel by texel, since text is set on whole pixels.
    color.a *= texelFetch(glyphs, ivec2(uv), 0).r;
  } else if (kind.x == 1.0) {
    // A panel with round corners: uv from its center, then half width, half height and corner radius [pixels].
    vec2 outside = abs(uv) - kind.yz + kind.w;
    float d = length(max(outside, vec2(0.0))) + min(max(outside.x, outside.y), 0.0) - kind.w;
    color.a *= clamp(0.5 - d, 0.0, 1.0);
  } else {
    color.rgb = textureLod(color_map, vec2(clamp(uv.x, 0.0, 1.0) * 255.0 / 256.0 + 0.5 / 256.0, 0.5), 0.0).rgb;
  }
}
