// Where the section's plane crosses a tetrahedron: a triangle or a quadrilateral, its front towards what is cut away.
#include "render/layout.glsl"
#include "render/sight.glsl"

layout(lines_adjacency) in;
layout(triangle_strip, max_vertices = 4) out;
in vec4 vertex_place_and_shown[];
flat in uint vertex_particle[];
#ifdef PICKED
flat out uvec4 particles;
out vec4 squares;  // of the distances to the four [m²]
out float along;   // the view [m]
#else
out vec3 world;
out vec3 from_eye;
out vec3 place;
out float shown;
#endif

void main() {
  float over[4];
  int beyond[4];
  int within[4];
  int beyond_count = 0;
  int within_count = 0;
  for (int i = 0; i < 4; ++i) {
    over[i] = dot(cut.xyz, gl_in[i].gl_Position.xyz) - section.x;
    if (over[i] > 0.0)
      beyond[beyond_count++] = i;
    else
      within[within_count++] = i;
  }
  if (beyond_count == 0 || within_count == 0) return;

  // The edges that are crossed, two corners each: all from the one corner that is alone on its side, or two from two.
  ivec2 crossed[4];
  int count = beyond_count == 2 ? 4 : 3;
  for (int i = 0; i < count; ++i) {
    if (beyond_count == 1)
      crossed[i] = ivec2(beyond[0], within[i]);
    else if (beyond_count == 3)
      crossed[i] = ivec2(beyond[i], within[0]);
    else
      crossed[i] = ivec2(beyond[i >> 1], within[i & 1]);
  }
  vec3 at[4];
  float share[4];
  for (int i = 0; i < count; ++i) {
    int a = crossed[i].x;
    int b = crossed[i].y;
    share[i] = over[a] / (over[a] - over[b]);
    at[i] = mix(gl_in[a].gl_Position.xyz, gl_in[b].gl_Position.xyz, share[i]);
  }
  bool turned = dot(cross(at[1] - at[0], at[2] - at[0]), cut.xyz) < 0.0;
  for (int n = 0; n < count; ++n) {
    int i = turned && (n == 1 || n == 2) ? 3 - n : n;
#ifdef PICKED
    for (int corner = 0; corner < 4; ++corner) {
      vec3 off = gl_in[corner].gl_Position.xyz - at[i];
      squares[corner] = dot(off, off);
    }
    particles = uvec4(vertex_particle[0], vertex_particle[1], vertex_particle[2], vertex_particle[3]);
    along = -(view * vec4(at[i], 1.0)).z;
#else
    world = at[i];
    from_eye = way_from_eye(at[i]);
    vec4 both = mix(vertex_place_and_shown[crossed[i].x], vertex_place_and_shown[crossed[i].y], share[i]);
    place = both.xyz;
    shown = both.w;
#endif
    gl_Position = view_projection * vec4(at[i], 1.0);
    EmitVertex();
  }
  EndPrimitive();
}
