// One triangle over the complete image.
out vec2 on_screen;

void main() {
  vec2 corner = vec2((gl_VertexID & 1) * 4 - 1, (gl_VertexID >> 1) * 4 - 1);
  on_screen = corner;
  gl_Position = vec4(corner, 1.0, 1.0);
}
