#include "render/frame.glsl"
#include "render/landscape.glsl"
#include "render/sight.glsl"

in vec2 on_screen;
layout(location = 0) out vec4 color;

void main() {
  vec4 far = clip_to_world * vec4(on_screen, 1.0, 1.0);
  color = vec4(to_display(landscape(-to_eye(far.xyz / far.w))), 1.0);
}
