in vec3 from_eye;
layout(location = 0) out float thickness;

void main() { thickness = gl_FrontFacing ? -length(from_eye) : length(from_eye); }
