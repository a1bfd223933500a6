// How much of a body a sight line crosses: front faces count minus their distance, back faces plus it.
#include "render/layout.glsl"
#include "render/sight.glsl"
#include "render/cut.glsl"

layout(location = ATTRIBUTE_POSITION) in vec4 position;
out vec3 from_eye;

void main() {
  from_eye = way_from_eye(position.xyz);
  gl_Position = view_projection * vec4(position.xyz, 1.0);
  gl_ClipDistance[0] = kept(position.xyz);
}
