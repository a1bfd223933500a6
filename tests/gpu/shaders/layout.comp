// Blocks whose layout the test knows from the rules of std430 and std140, and one uniform of each kind.
#include "compute/dispatch.glsl"
struct Item {
  vec4 position;
  float mass;
  uint flags;
};
layout(std430, binding = 3) buffer Items {
  uint header;
  float weights[4];
  Item items[];
};
layout(std140, binding = 5) uniform Classes {
  float scale;
  float factors[3];
};
layout(location = 1) uniform uint count;
layout(location = 2) uniform int shift;
layout(location = 3) uniform float gain;
layout(location = 4) uniform vec4 gravity;

void main() {
  uint i = item_index();
  if (i >= count) return;
  items[i].position = vec4(gravity.xyz, gain);
  items[i].mass = weights[2];
  items[i].flags = header + uint(int(i) + shift);
  weights[3] = factors[1];
}
