// Where particles are; w: what colors show there.
uniform sampler2D particles;

vec4 particle(uint i) { return texelFetch(particles, ivec2(int(i & 1023u), int(i >> 10)), 0); }
