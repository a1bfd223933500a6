in float depth;
in vec2 on_disc;
layout(location = 0) out vec2 covered;

void main() {
  if (dot(on_disc, on_disc) > 1.0) discard;
  covered = vec2(1.0, depth);
}
