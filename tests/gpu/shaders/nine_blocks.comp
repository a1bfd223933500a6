// One storage block more than OpenGL 4.3 guarantees, unless EIGHT is defined.
#include "compute/dispatch.glsl"
layout(std430, binding = 0) buffer Block0 { uint v0[]; };
layout(std430, binding = 1) buffer Block1 { uint v1[]; };
layout(std430, binding = 2) buffer Block2 { uint v2[]; };
layout(std430, binding = 3) buffer Block3 { uint v3[]; };
layout(std430, binding = 4) buffer Block4 { uint v4[]; };
layout(std430, binding = 5) buffer Block5 { uint v5[]; };
layout(std430, binding = 6) buffer Block6 { uint v6[]; };
layout(std430, binding = 7) buffer Block7 { uint v7[]; };
#ifdef EIGHT
#define LAST 0u
#else
layout(std430, binding = 8) buffer Block8 { uint v8[]; };
#define LAST v8[i]
#endif

void main() {
  uint i = item_index();
  v0[i] = v1[i] + v2[i] + v3[i] + v4[i] + v5[i] + v6[i] + v7[i] + LAST;
}
