// Triangles of the skin that the ID image may show, each with the three particles it joins.
#include "render/layout.glsl"
#include "render/cut.glsl"

layout(triangles) in;
layout(triangle_strip, max_vertices = 3) out;
flat in uint vertex_particle[];
flat out uvec3 particles;
// Squares of the distances to the three [m²]: their differences vary evenly over the triangle.
out vec3 squares;
out float along;  // the view [m]

void main() {
  vec4 clip[3];
  for (int i = 0; i < 3; ++i) clip[i] = view_projection * gl_in[i].gl_Position;
  // All beyond one border, or all behind the eye.
  for (int axis = 0; axis < 2; ++axis) {
    vec3 at = vec3(clip[0][axis], clip[1][axis], clip[2][axis]);
    vec3 w = vec3(clip[0].w, clip[1].w, clip[2].w);
    if (all(greaterThan(at, w)) || all(lessThan(at, -w))) return;
  }
  for (int i = 0; i < 3; ++i) {
    vec3 here = gl_in[i].gl_Position.xyz;
    for (int corner = 0; corner < 3; ++corner) {
      vec3 off = gl_in[corner].gl_Position.xyz - here;
      squares[corner] = dot(off, off);
    }
    particles = uvec3(vertex_particle[0], vertex_particle[1], vertex_particle[2]);
    along = -(view * gl_in[i].gl_Position).z;
    gl_Position = clip[i];
    gl_ClipDistance[0] = kept(here);
    EmitVertex();
  }
  EndPrimitive();
}
