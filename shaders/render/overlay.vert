// Rectangles of the overlay, in pixels from the top left.
#include "render/layout.glsl"

layout(location = 0) in vec4 place;   // x, y [pixels]; u, v
layout(location = 1) in vec4 tint;    // linear color, alpha
layout(location = 2) in vec4 shape;   // what to fill with (overlay.frag), then its parameters
out vec2 uv;
out vec4 fill;
flat out vec4 kind;

void main() {
  uv = place.zw;
  fill = tint;
  kind = shape;
  vec2 ndc = place.xy * viewport.zw * 2.0 - 1.0;
  gl_Position = vec4(ndc.x, -ndc.y, 0.0, 1.0);
}
