in vec3 from_eye;
out vec4 thickness;

void main() { thickness = vec4(gl_FrontFacing ? -length(from_eye) : length(from_eye), 0.0, 0.0, 0.0); }
