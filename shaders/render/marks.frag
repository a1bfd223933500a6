// Marks in two tones, a light one within a dark one, so that they are seen on any ground.
#include "render/layout.glsl"

layout(location = LOCATION_BASE_COLOR) uniform vec4 base_color;
layout(location = LOCATION_MARK) uniform vec4 mark;
in vec2 at;
flat in float pixel;
layout(location = 0) out vec4 color;

// Signed distance from the mark's light part, in its radii, and that of its dark rim.
vec2 shape() {
  float r = length(at);
  if (mark.x == MARK_RING) return vec2(abs(r - 0.80) - 0.11, abs(r - 0.80) - 0.20);
  if (mark.x == MARK_LINE) return vec2(abs(at.x) - 0.5, abs(at.x) - 1.0);
  if (mark.x == MARK_ANCHOR) {
    vec2 a = abs(at);
    float cross_arms = min(max(a.x - 0.12, a.y - 0.55), max(a.y - 0.12, a.x - 0.55));
    return vec2(max(r - 0.78, -cross_arms), r - 1.0);
  }
  float diamond = (abs(at.x) + abs(at.y)) * 0.7071;
  return vec2(diamond - 0.44, diamond - 0.70);
}

void main() {
  vec2 d = shape() / pixel;
  float light = clamp(0.5 - d.x, 0.0, 1.0);
  float cover = clamp(0.5 - d.y, 0.0, 1.0);
  if (cover <= 0.0) discard;
  vec3 shown = mix(vec3(0.012), base_color.rgb, light);
  if (mark.w > 0.0)
    shown = mix(1.055 * pow(shown, vec3(1.0 / 2.4)) - 0.055, 12.92 * shown, lessThanEqual(shown, vec3(0.0031308)));
  color = vec4(shown, cover * mark.z);
}
