out vec2 on_screen;
void main() {
  on_screen = vec2(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0);
  gl_Position = vec4(on_screen, 0.0, 1.0);
}
