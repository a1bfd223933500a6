in float depth;
layout(location = 0) out vec2 covered;

void main() { covered = vec2(1.0, depth); }
