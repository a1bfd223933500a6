// A square before each particle that the ID image may show, for a disc a few pixels wide.
#include "render/layout.glsl"
#include "render/sight.glsl"
#include "render/cut.glsl"

layout(points) in;
layout(triangle_strip, max_vertices = 4) out;
layout(location = LOCATION_RADIUS) uniform float radius;
out vec2 on_disc;
flat out vec3 center;
flat out float size;

const float least = 3.0;  // radius [pixels]

void main() {
  if (kept(gl_in[0].gl_Position.xyz) < 0.0) return;
  vec4 at = view * vec4(gl_in[0].gl_Position.xyz, 1.0);
  float pixel = pixel_at(-at.z);
  float r = max(radius, least * pixel);
  vec4 clip = projection * at;
  vec2 reach = r * vec2(projection[0][0], projection[1][1]);
  // Nearly all particles stand beside the small image, or behind the eye.
  if (clip.w <= 0.0 || any(greaterThan(abs(clip.xy), vec2(clip.w) + reach))) return;
  for (int corner = 0; corner < 4; ++corner) {
    on_disc = vec2((corner & 1) * 2 - 1, (corner >> 1) * 2 - 1);
    center = at.xyz;
    size = r;
    gl_Position = vec4(clip.xy + reach * on_disc, clip.zw);
    gl_PrimitiveID = gl_PrimitiveIDIn;
    EmitVertex();
  }
  EndPrimitive();
}
