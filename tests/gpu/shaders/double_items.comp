// Doubles every item of one buffer into another.
#include "compute/dispatch.glsl"
layout(std430, binding = 0) readonly buffer Input {
  uint given[];
};
layout(std430, binding = 1) writeonly buffer Output {
  uint doubled[];
};
layout(location = 0) uniform uint count;

void main() {
  uint i = item_index();
  if (i >= count) return;
  doubled[i] = 2u * given[i];
}
